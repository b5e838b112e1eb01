# find_package(mrpt-hgmm) for other projects, from the prefix or from this build tree.
include(CMakePackageConfigHelpers)

set(HGMM_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/mrpt-hgmm)
configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/cmake/mrpt-hgmm-config.cmake.in
    ${PROJECT_BINARY_DIR}/mrpt-hgmm-config.cmake
    INSTALL_DESTINATION ${HGMM_CONFIG_DIR})
write_basic_package_version_file(
    ${PROJECT_BINARY_DIR}/mrpt-hgmm-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
    ${PROJECT_BINARY_DIR}/mrpt-hgmm-config.cmake
    ${PROJECT_BINARY_DIR}/mrpt-hgmm-config-version.cmake
    DESTINATION ${HGMM_CONFIG_DIR})

# Two export sets, because the core and the plugin carry different namespaces.
install(EXPORT hgmm-core-targets NAMESPACE hgmm:: DESTINATION ${HGMM_CONFIG_DIR})
if(HGMM_BUILD_MRPT)
    install(EXPORT hgmm-plugin-targets NAMESPACE mrpt:: DESTINATION ${HGMM_CONFIG_DIR})
endif()
