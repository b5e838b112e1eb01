# Libraries for other projects, which find them in the prefix by find_package(hgmm) and
# find_package(mrpt-hgmm), or by the same names for pkg-config.
include(CMakePackageConfigHelpers)
include(HgmmPkgConfig)

# hgmm_install_library(TARGET NAMESPACE COMPONENT DEPENDENCY)
# COMPONENT is what running programs need; COMPONENT-dev is for those who compile. DEPENDENCY is
# the target of others that the library's headers need. Headers are those of the library's folder
# when built here, of the prefix when installed.
function(hgmm_install_library TARGET NAMESPACE COMPONENT DEPENDENCY)
    target_include_directories(${TARGET} PUBLIC
        $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    set_target_properties(${TARGET} PROPERTIES
        VERSION ${PROJECT_VERSION} SOVERSION ${HGMM_SOVERSION})
    install(TARGETS ${TARGET} EXPORT ${TARGET}-targets
        LIBRARY COMPONENT ${COMPONENT} NAMELINK_COMPONENT ${COMPONENT}-dev)
    install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${COMPONENT}-dev)
    hgmm_install_config(${TARGET} ${NAMESPACE} ${COMPONENT}-dev)
    hgmm_install_pc(${TARGET} ${COMPONENT}-dev ${DEPENDENCY})
endfunction()

# What find_package(TARGET) reads.
function(hgmm_install_config TARGET NAMESPACE COMPONENT)
    set(CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/${TARGET})
    configure_package_config_file(
        ${PROJECT_SOURCE_DIR}/cmake/${TARGET}-config.cmake.in
        ${PROJECT_BINARY_DIR}/${TARGET}-config.cmake
        INSTALL_DESTINATION ${CONFIG_DIR})
    write_basic_package_version_file(
        ${PROJECT_BINARY_DIR}/${TARGET}-config-version.cmake COMPATIBILITY SameMinorVersion)
    install(FILES
        ${PROJECT_BINARY_DIR}/${TARGET}-config.cmake
        ${PROJECT_BINARY_DIR}/${TARGET}-config-version.cmake
        DESTINATION ${CONFIG_DIR} COMPONENT ${COMPONENT})
    install(EXPORT ${TARGET}-targets NAMESPACE ${NAMESPACE}::
        DESTINATION ${CONFIG_DIR} COMPONENT ${COMPONENT})
endfunction()
