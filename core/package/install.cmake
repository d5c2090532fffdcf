# What `cmake --install` puts where, for find_package(palpate), for pkg-config and for cpack.
#
# Headers keep their rooms, under include/palpate/; <palpate/recognizer.h>, <palpate/curve.h> and
# <palpate/client.h> are the doors.
include(CMakePackageConfigHelpers)

set(PALPATE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
# From a .pc file to the prefix, wherever that is moved.
file(RELATIVE_PATH palpate_pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
set(palpate_doors ${PROJECT_BINARY_DIR}/include/palpate)

# Before 1.0 a minor version may change the binary interface.
set(palpate_soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

# palpate_install_libraries(SET <core|client> TARGETS ...)
function(palpate_install_libraries)
  cmake_parse_arguments(ARG "" "SET" "TARGETS" ${ARGN})
  set_target_properties(${ARG_TARGETS} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${palpate_soversion})
  install(TARGETS ${ARG_TARGETS} EXPORT palpate-${ARG_SET}-targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT dev
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${CMAKE_INSTALL_INCLUDEDIR}/palpate)
  install(EXPORT palpate-${ARG_SET}-targets NAMESPACE palpate:: DESTINATION ${PALPATE_CMAKE_DIR} COMPONENT dev)
  configure_file(${PROJECT_SOURCE_DIR}/core/package/palpate-${ARG_SET}.pc.in palpate-${ARG_SET}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpate-${ARG_SET}.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endfunction()

# palpate_door(NAME <name> INCLUDES <header>...)
function(palpate_door)
  cmake_parse_arguments(ARG "" "NAME" "INCLUDES" ${ARGN})
  set(text "#pragma once\n\n")
  foreach(header IN LISTS ARG_INCLUDES)
    string(APPEND text "#include \"${header}\"\n")
  endforeach()
  file(CONFIGURE OUTPUT ${palpate_doors}/${ARG_NAME}.h CONTENT "${text}")
  install(FILES ${palpate_doors}/${ARG_NAME}.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate COMPONENT dev)
endfunction()

palpate_install_libraries(SET core TARGETS palpate_core)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/core DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate COMPONENT dev
        FILES_MATCHING PATTERN "*.h" PATTERN package EXCLUDE)
palpate_door(NAME recognizer INCLUDES core/recognition/recognizer.h)
palpate_door(NAME curve INCLUDES core/curves/curve.h)
palpate_door(NAME part INCLUDES core/part/closed_spline.h core/part/segment_match.h)

if(TARGET palpate_client)
  palpate_install_libraries(SET client TARGETS palpate_client palpate_proto palpate_topics)
  foreach(room client wire files intake)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/node/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate/node
            COMPONENT dev FILES_MATCHING PATTERN "*.h")
  endforeach()
  install(DIRECTORY ${PROJECT_BINARY_DIR}/proto/cpp/palpate/v1 DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate
          COMPONENT dev FILES_MATCHING PATTERN "*.h")
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/proto/palpate/v1 DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate/proto/palpate
          COMPONENT dev FILES_MATCHING PATTERN "*.proto")
  palpate_door(NAME client INCLUDES
    node/client/connection.h node/client/contact_publisher.h node/client/result_subscriber.h)
  install(TARGETS palpate palpate-node RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
  install(FILES ${PROJECT_SOURCE_DIR}/node/package/palpate-node.service DESTINATION lib/systemd/system COMPONENT runtime)
endif()
if(TARGET palpate-sim)
  install(TARGETS palpate-sim RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/sim/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate COMPONENT runtime)
endif()

foreach(program palpate palpate-node palpate-sim)
  if(BUILD_SHARED_LIBS AND TARGET ${program})
    set_target_properties(${program} PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  endif()
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/core/package/palpate-config.cmake.in palpate-config.cmake
                              INSTALL_DESTINATION ${PALPATE_CMAKE_DIR})
write_basic_package_version_file(palpate-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpate-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/palpate-config-version.cmake
        DESTINATION ${PALPATE_CMAKE_DIR} COMPONENT dev)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)

# cpack -G DEB: palpate and libpalpate-dev.
set(CPACK_PACKAGE_NAME palpate)
set(CPACK_PACKAGE_CONTACT "palpate developers <palpate@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_COMPONENTS_ALL runtime dev)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME palpate)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libpalpate-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "palpate (= ${PROJECT_VERSION}), libeigen3-dev, libprotobuf-dev, cppzmq-dev")
include(CPack)
