# Libraries for other projects, which find them in the prefix by find_package(TARGET), or by the same
# name for pkg-config.
include(CMakePackageConfigHelpers)
include(HgmmPkgConfig)

# hgmm_install_library(TARGET NAMESPACE name COMPONENT name
#     [REQUIRES name...] [FINDS "package version"...] [FLAGS_OF target])
# COMPONENT is what running programs need; COMPONENT-dev is for those who compile.
# REQUIRES: libraries of this project; FINDS: packages of others, for find_package;
# FLAGS_OF: a target of others whose flags the headers need, for pkg-config.
# Headers are those of the library's folder when built here, of the prefix when installed.
function(hgmm_install_library TARGET)
    cmake_parse_arguments(ARG "" "NAMESPACE;COMPONENT;FLAGS_OF" "REQUIRES;FINDS" ${ARGN})
    target_include_directories(${TARGET} PUBLIC
        $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    set_target_properties(${TARGET} PROPERTIES
        VERSION ${PROJECT_VERSION} SOVERSION ${HGMM_SOVERSION})
    set(DEV ${ARG_COMPONENT}-dev)
    install(TARGETS ${TARGET} EXPORT ${TARGET}-targets
        LIBRARY COMPONENT ${ARG_COMPONENT} NAMELINK_COMPONENT ${DEV})
    install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${DEV})

    set(DEPENDENCIES "")
    foreach(NAME ${ARG_REQUIRES})
        string(APPEND DEPENDENCIES "find_dependency(${NAME} ${PROJECT_VERSION} CONFIG "
            "HINTS \${CMAKE_CURRENT_LIST_DIR}/../${NAME})\n")
    endforeach()
    foreach(PACKAGE ${ARG_FINDS})
        string(APPEND DEPENDENCIES "find_dependency(${PACKAGE})\n")
    endforeach()
    get_target_property(EXPORTED ${TARGET} EXPORT_NAME)
    if(NOT EXPORTED)
        set(EXPORTED ${TARGET})
    endif()
    set(CONFIG ${PROJECT_BINARY_DIR}/${TARGET}-config)
    set(CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/${TARGET})
    configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/library-config.cmake.in ${CONFIG}.cmake
        INSTALL_DESTINATION ${CONFIG_DIR})
    write_basic_package_version_file(${CONFIG}-version.cmake COMPATIBILITY SameMinorVersion)
    install(FILES ${CONFIG}.cmake ${CONFIG}-version.cmake DESTINATION ${CONFIG_DIR} COMPONENT ${DEV})
    install(EXPORT ${TARGET}-targets NAMESPACE ${ARG_NAMESPACE}::
        DESTINATION ${CONFIG_DIR} COMPONENT ${DEV})
    hgmm_install_pc(${TARGET} ${DEV})
endfunction()
