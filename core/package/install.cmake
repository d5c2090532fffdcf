# What `cmake --install` puts where, for find_package(palpate), for pkg-config and for cpack.
#
# Headers keep their rooms, under include/palpate/, beside their doors (doors.cmake).
include(CMakePackageConfigHelpers)
include(${CMAKE_CURRENT_LIST_DIR}/libraries.cmake)

set(PALPATE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)
# From a .pc file to the prefix, wherever that is moved.
file(RELATIVE_PATH palpate_pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)

function(palpate_install_door name)
  install(FILES ${palpate_doors_dir}/palpate/${name}.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate COMPONENT dev)
endfunction()

# palpate_install_headers(<header>...): each in its room.
function(palpate_install_headers)
  foreach(header IN LISTS ARGN)
    cmake_path(GET header PARENT_PATH room)
    install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate/${room}
            COMPONENT dev)
  endforeach()
endfunction()

function(palpate_install_pc set)
  configure_file(${PROJECT_SOURCE_DIR}/core/package/palpate-${set}.pc.in palpate-${set}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpate-${set}.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endfunction()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
palpate_library(SET core OBJECTS palpate_core LINKS Eigen3::Eigen NAMESPACES palpate
                DOORS ${palpate_recognizer_door} ${palpate_curve_door} ${palpate_part_door} ${palpate_given_class_door})
palpate_install_headers(${palpate_core_headers})
palpate_install_pc(core)
foreach(door IN LISTS palpate_core_doors)
  palpate_install_door(${door})
endforeach()

if(TARGET palpate_client)
  find_package(Protobuf 3.21 REQUIRED)
  find_package(cppzmq REQUIRED)
  palpate_library(SET client OBJECTS palpate_client palpate_topics palpate_proto LINKS protobuf::libprotobuf cppzmq
                  NAMESPACES palpate palpate::client DOORS ${palpate_client_door}
                  ALSO palpate::v1::* "* for palpate::v1::*")
  palpate_install_headers(${palpate_client_headers})
  palpate_install_pc(client)
  palpate_install_door(client)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/proto/cpp/palpate/v1 DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate
          COMPONENT dev FILES_MATCHING PATTERN "*.h")
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/proto/palpate/v1 DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate/proto/palpate
          COMPONENT dev FILES_MATCHING PATTERN "*.proto")
endif()
if(TARGET palpate-node)
  install(TARGETS palpate palpate-node RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
endif()
if(TARGET palpate-sim)
  install(TARGETS palpate-sim RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/sim/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/palpate COMPONENT runtime)
endif()

# API pages of all of it, where Doxygen is: target palpate_api. A warning is an error.
find_program(PALPATE_DOXYGEN doxygen)
if(PALPATE_DOXYGEN)
  set(palpate_api_files ${palpate_core_headers} ${palpate_client_headers})
  list(TRANSFORM palpate_api_files PREPEND ${PROJECT_SOURCE_DIR}/)
  list(JOIN palpate_api_files " " palpate_api_files)
  configure_file(${PROJECT_SOURCE_DIR}/core/package/Doxyfile.in Doxyfile @ONLY)
  add_custom_target(palpate_api COMMAND ${PALPATE_DOXYGEN} ${CMAKE_CURRENT_BINARY_DIR}/Doxyfile
                    COMMENT "API pages in ${PROJECT_BINARY_DIR}/api/html" VERBATIM)
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/core/package/palpate-config.cmake.in palpate-config.cmake
                              INSTALL_DESTINATION ${PALPATE_CMAKE_DIR})
write_basic_package_version_file(palpate-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpate-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/palpate-config-version.cmake
        DESTINATION ${PALPATE_CMAKE_DIR} COMPONENT dev)
# Debian's packages have it in their copyright file.
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)
if(TARGET palpate-node)
  include(${PROJECT_SOURCE_DIR}/node/package/install.cmake)
endif()
include(${CMAKE_CURRENT_LIST_DIR}/deb.cmake)
