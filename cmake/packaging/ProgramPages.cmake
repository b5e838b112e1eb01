# Man pages of the programs and their subcommands, and what bash completes, from what they print
# for --help. Programs are all executables of apps/*.

function(hgmm_program_pages)
    get_property(FOLDERS DIRECTORY ${PROJECT_SOURCE_DIR}/apps PROPERTY SUBDIRECTORIES)
    set(PROGRAMS "")
    foreach(FOLDER ${FOLDERS})
        get_property(TARGETS DIRECTORY ${FOLDER} PROPERTY BUILDSYSTEM_TARGETS)
        foreach(TARGET ${TARGETS})
            get_target_property(TYPE ${TARGET} TYPE)
            if(TYPE STREQUAL "EXECUTABLE")
                list(APPEND PROGRAMS ${TARGET})
            endif()
        endforeach()
    endforeach()
    set(PAGES ${PROJECT_BINARY_DIR}/man1)
    set(COMPLETIONS ${PROJECT_BINARY_DIR}/completions)
    add_custom_command(OUTPUT ${PAGES} ${COMPLETIONS}
        COMMAND ${HGMM_PACKAGING_DIR}/man-pages.sh ${PROJECT_VERSION} ${PAGES} ${PROGRAMS}
        COMMAND ${HGMM_PACKAGING_DIR}/bash-completion.sh ${COMPLETIONS} ${PROGRAMS}
        WORKING_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
        DEPENDS ${PROGRAMS} ${HGMM_PACKAGING_DIR}/man-pages.sh ${HGMM_PACKAGING_DIR}/bash-completion.sh
            ${HGMM_PACKAGING_DIR}/subcommands.sh
        COMMENT "Man pages and completions of ${PROGRAMS}"
        VERBATIM)
    add_custom_target(program-pages ALL DEPENDS ${PAGES} ${COMPLETIONS})
    install(DIRECTORY ${PAGES} DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT tools)
    install(DIRECTORY ${COMPLETIONS}
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion COMPONENT tools)
endfunction()
