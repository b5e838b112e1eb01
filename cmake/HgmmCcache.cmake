# Compiles through ccache where it is installed, unless the caller has a launcher of its own.
# Precompiled headers need its sloppiness: their time stamps and macros are not compared.
if(HGMM_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    find_program(HGMM_CCACHE_PROGRAM ccache)
    mark_as_advanced(HGMM_CCACHE_PROGRAM)
    if(HGMM_CCACHE_PROGRAM)
        set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
            CCACHE_SLOPPINESS=pch_defines,time_macros ${HGMM_CCACHE_PROGRAM})
    endif()
endif()
