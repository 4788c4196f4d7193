# The Debian package: `cpack -G DEB` in the folder of the release preset, after a whole build. package_files.cmake adds
# what only a package has.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lumulus)
set(CPACK_PACKAGE_VENDOR "The Lumulus authors")
# Who makes a package maintains it, and is named as by Debian's own tools: DEBFULLNAME and DEBEMAIL. Where they are not
# set, the package is for this machine, and so is the address.
set(maintainer "Local build")
cmake_host_system_information(RESULT host QUERY FQDN)
if(NOT host MATCHES "\\.")
  string(APPEND host ".local")
endif()
set(address "nobody@${host}")
if(NOT "$ENV{DEBFULLNAME}" STREQUAL "" AND NOT "$ENV{DEBEMAIL}" STREQUAL "")
  set(maintainer "$ENV{DEBFULLNAME}")
  set(address "$ENV{DEBEMAIL}")
endif()
set(LUMULUS_MAINTAINER "${maintainer} <${address}>" CACHE STRING "Maintainer of the Debian package: NAME <ADDRESS>")
set(CPACK_PACKAGE_CONTACT "${LUMULUS_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "renderer of clouds, fog and air by photon maps")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Lumulus renders clouds from OpenVDB density grids or procedural shapes, with
physically based light of sun, sky and lamps, to EXR and PNG pictures. It has a
frame service for simulators and browsers, a path tracer that judges its
pictures, a client library for C++, and a module for Python. Its Vulkan compute
shaders run on graphics cards and, by Mesa's lavapipe, on any machine without.")
set(CPACK_PACKAGE_FILE_NAME lumulus_${PROJECT_VERSION}-1_amd64)
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Vulkan is loaded at run time, and the module is for one version of Python.
set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "libvulkan1, mesa-vulkan-drivers | vulkan-icd, python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-openvdb, libopenexr-dev, libimath-dev, libssl-dev")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE gzip)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
file(WRITE ${CMAKE_BINARY_DIR}/package/conffiles "/etc/lumulus/service.toml\n")
foreach(script postinst prerm)
  configure_file(${CMAKE_SOURCE_DIR}/configs/debian/${script} ${CMAKE_BINARY_DIR}/package/${script} COPYONLY)
endforeach()
configure_file(${CMAKE_SOURCE_DIR}/configs/debian/changelog.in ${CMAKE_BINARY_DIR}/package/changelog @ONLY)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
    "${CMAKE_BINARY_DIR}/package/conffiles;${CMAKE_BINARY_DIR}/package/postinst;${CMAKE_BINARY_DIR}/package/prerm")
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/package_files.cmake)
set(CPACK_LUMULUS_SOURCE ${CMAKE_SOURCE_DIR})
set(CPACK_LUMULUS_BINARY ${CMAKE_BINARY_DIR})
include(CPack)
