# Debian packages, by CPack: one for each component of the installation. scripts/package.sh makes them.
include(packaging/DebianFiles)
include(packaging/ProgramPages)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mrpt-hgmm)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
# Each package has its own.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${HGMM_DEBIAN_REVISION})
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${HGMM_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION TRUE)
# Depends are what dpkg-shlibdeps finds. Libraries of other packages of this build are named below.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")

set(SAME "(= ${PROJECT_VERSION}-${HGMM_DEBIAN_REVISION})")
set(AT_LEAST "(>= ${PROJECT_VERSION})")
set(CORE libhgmm${HGMM_SOVERSION})
set(PLUGIN libmrpt-hgmm${HGMM_SOVERSION})
set(BUILDER libmrpt-hgmm-builder${HGMM_SOVERSION})

hgmm_library_deb(core ${CORE}
    SUMMARY "3D occupancy map made of Gaussians - library"
    ABOUT "This package has the model, which needs no MRPT.")
hgmm_deb(core-dev libhgmm-dev SECTION libdevel
    DEPENDS "${CORE} ${SAME}" libeigen3-dev
    SUMMARY "3D occupancy map made of Gaussians - development files"
    ABOUT "This package has the model's headers, and its files for CMake and pkg-config.")
hgmm_library_deb(plugin ${PLUGIN}
    DEPENDS "${CORE} ${AT_LEAST}"
    SUGGESTS mrpt-apps
    SUMMARY "3D occupancy map made of Gaussians - plugin for MRPT"
    ABOUT "This package has the map class of MRPT. Programs of MRPT take it when it is"
        "preloaded: LD_PRELOAD=libmrpt-hgmm.so.${HGMM_SOVERSION}")
hgmm_deb(plugin-dev libmrpt-hgmm-dev SECTION libdevel
    DEPENDS "${PLUGIN} ${SAME}" "libhgmm-dev ${SAME}" libmrpt-maps-dev
    SUMMARY "3D occupancy map made of Gaussians - development files of the plugin"
    ABOUT "This package has the headers of the map class of MRPT, and its files for CMake"
        "and pkg-config.")
hgmm_library_deb(builder ${BUILDER}
    DEPENDS "${CORE} ${AT_LEAST}" "${PLUGIN} ${AT_LEAST}"
    SUMMARY "3D occupancy map made of Gaussians - map builder for MRPT"
    ABOUT "This package has simultaneous localisation and mapping as one of MRPT's map"
        "builders.")
hgmm_deb(builder-dev libmrpt-hgmm-builder-dev SECTION libdevel
    DEPENDS "${BUILDER} ${SAME}" "libmrpt-hgmm-dev ${SAME}" libmrpt-slam-dev
    SUMMARY "3D occupancy map made of Gaussians - development files of the builder"
    ABOUT "This package has the header of the map builder, and its files for CMake and"
        "pkg-config.")
hgmm_deb(tools mrpt-hgmm-tools SECTION science
    DEPENDS "${CORE} ${AT_LEAST}" "${PLUGIN} ${AT_LEAST}"
    RECOMMENDS mrpt-apps python3-hgmm
    SUMMARY "3D occupancy map made of Gaussians - programs"
    ABOUT "This package has programs that make maps of recordings, and query and export"
        "them, and configurations for programs of MRPT.")
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/mrpt-hgmm-tools COMPONENT tools)
install(FILES README.md BENCHMARK.md SECURITY.md
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/mrpt-hgmm-tools COMPONENT tools)
hgmm_python_deb(python python3-hgmm
    SUMMARY "3D occupancy map made of Gaussians - Python package"
    ABOUT "This package has the model with numpy arrays in and out. It needs no MRPT.")

get_property(CPACK_COMPONENTS_ALL GLOBAL PROPERTY HGMM_COMPONENTS)
hgmm_program_pages()
include(CPack)
