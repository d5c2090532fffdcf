# cpack -G DEB: palpate (programs), palpate-gateway, libpalpate-dev (static libraries and headers) and python3-palpate. Before 1.0 every
# minor version may break the binary interface, so that a package of shared libraries would serve nobody:
# `cmake --install` has them.
set(CPACK_PACKAGE_NAME palpate)
set(CPACK_PACKAGE_VENDOR "palpate")
set(CPACK_PACKAGE_CONTACT "palpate maintainers <maintainers@palpate.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_COMPONENTS_ALL dev)
if(TARGET palpate-node)
  list(APPEND CPACK_COMPONENTS_ALL runtime)
endif()
if(TARGET palpate-gateway)
  list(APPEND CPACK_COMPONENTS_ALL gateway)
endif()
if(TARGET palpate_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 0palpate1)  # not Debian's own
set(CPACK_DEBIAN_PACKAGE_SOURCE palpate)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(about "\
A probe strokes a part in any number of short patches; palpate says which
curve it touched (line, circle, ellipse, parabola, hyperbola, cubics, none of
these), its shape, its pose and the contacts on it, each with its uncertainty,
and says so when the data cannot tell.
.
")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME palpate)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "recognition of curved parts by touch
${about}This package has the tool for files and streams (palpate), the recognizer
(palpate-node), with a service that is not started by itself, and a simulator
of probes (palpate-sim).")
set(scripts ${PROJECT_SOURCE_DIR}/node/package/deb)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${scripts}/conffiles ${scripts}/postinst ${scripts}/prerm)

set(CPACK_DEBIAN_GATEWAY_PACKAGE_NAME palpate-gateway)
set(CPACK_DEBIAN_GATEWAY_PACKAGE_SECTION science)
set(CPACK_DEBIAN_GATEWAY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_GATEWAY_PACKAGE_DEPENDS palpate)
set(CPACK_DEBIAN_GATEWAY_PACKAGE_SUGGESTS nats-server)
set(CPACK_DEBIAN_GATEWAY_DESCRIPTION "recognition of curved parts by touch - many cells
${about}This package has the gateway between a cell and the streams of a NATS
server (JetStream): contacts kept, recognition shared over machines that may
die. Its services are not started by themselves.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libpalpate-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4), libprotobuf-dev (>= 3.21), protobuf-compiler, cppzmq-dev")
set(CPACK_DEBIAN_DEV_DESCRIPTION "recognition of curved parts by touch - development files
${about}This package has the static libraries for C++20, with find_package(palpate) and
pkg-config: the mathematics, and a client for probes and planners of a
recognizer.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-palpate)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${PALPATE_PYTHON_DEPENDS}, python3-numpy, python3-zmq, python3-protobuf")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-matplotlib)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "recognition of curved parts by touch - Python
${about}This package is for Python: recognition of numpy arrays, and probes and
planners of a recognizer.")
set(scripts ${PROJECT_SOURCE_DIR}/node/python/deb)
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${scripts}/postinst ${scripts}/prerm)

# What every package must have besides, and where Debian wants it.
set(version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
string(TIMESTAMP year "%Y" UTC)
configure_file(${CMAKE_CURRENT_LIST_DIR}/deb/changelog.in deb/changelog.Debian @ONLY)
configure_file(${CMAKE_CURRENT_LIST_DIR}/deb/copyright.in deb/copyright @ONLY)
configure_file(${CMAKE_CURRENT_LIST_DIR}/deb/arrange.cmake.in deb/arrange.cmake @ONLY)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_BINARY_DIR}/deb/arrange.cmake)
include(CPack)
