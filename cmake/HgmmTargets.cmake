# Compiler settings that every target of this project shares.

# Applies language level, warnings and sanitizers to one target.
# hgmm_target(TARGET [SANITIZERS names])    default: all of HGMM_SANITIZE
function(hgmm_target TARGET)
    cmake_parse_arguments(ARG "" "SANITIZERS" "" ${ARGN})
    if(HGMM_SANITIZE STREQUAL "thread")
        set(ARG_SANITIZERS thread)
        set(ALL_SANITIZERS thread)
    elseif(HGMM_SANITIZE STREQUAL "fuzzer")
        # Of undefined behaviour only what the address sanitizer does not see.
        set(ALL_SANITIZERS address,signed-integer-overflow,float-cast-overflow,shift)
        set(ARG_SANITIZERS fuzzer-no-link,${ALL_SANITIZERS})
    else()
        set(ALL_SANITIZERS address,undefined)
    endif()
    if(NOT ARG_SANITIZERS)
        set(ARG_SANITIZERS ${ALL_SANITIZERS})
    endif()
    target_compile_features(${TARGET} PUBLIC cxx_std_17)
    target_compile_options(${TARGET} PRIVATE
        -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wno-psabi
        $<$<BOOL:${HGMM_WARNINGS_AS_ERRORS}>:-Werror>)
    if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
        # Every file is then an included one, whose anonymous namespaces GCC distrusts.
        # Collecting garbage less often spares GCC a tenth of its time, for a tenth more memory.
        target_compile_options(${TARGET} PRIVATE
            -Wno-subobject-linkage --param ggc-min-heapsize=1000000)
    endif()
    if(HGMM_SANITIZE)
        target_compile_options(${TARGET} PRIVATE
            -fsanitize=${ARG_SANITIZERS} -fno-omit-frame-pointer -fno-sanitize-recover=all
            # Two fifths of the time to compile; null pointers and accesses outside of
            # objects are the address sanitizer's, too.
            -fno-sanitize=null,object-size,alignment,pointer-overflow)
        target_link_options(${TARGET} PUBLIC -fsanitize=${ALL_SANITIZERS})
    endif()
endfunction()

# Precompiles the headers of others that most files of a target include: half of its build time,
# but for unity builds, whose few files parse them in the time that they take to precompile.
# hgmm_precompile(TARGET <header> ...)
# hgmm_precompile(TARGET REUSE_FROM other)    those of a target that is compiled alike
function(hgmm_precompile TARGET)
    cmake_parse_arguments(ARG "" "REUSE_FROM" "" ${ARGN})
    if(CMAKE_UNITY_BUILD OR CMAKE_DISABLE_PRECOMPILE_HEADERS)
        return()
    endif()
    if(HGMM_CCACHE_PROGRAM)  # needs headers that are the same bytes each time
        target_compile_options(${TARGET} PRIVATE
            $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>
            $<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>)
    endif()
    if(ARG_REUSE_FROM)
        target_precompile_headers(${TARGET} REUSE_FROM ${ARG_REUSE_FROM})
        return()
    endif()
    target_precompile_headers(${TARGET} PRIVATE
        <Eigen/Dense> <algorithm> <cmath> <functional> <memory> <string> <unordered_map> <vector>
        ${ARG_UNPARSED_ARGUMENTS})
endfunction()

# A GoogleTest program. Its cases run in shares of one process each: a process loads MRPT's
# libraries for .4 s, longer than most cases take.
# hgmm_test(NAME SOURCES a.cpp ... LIBRARIES lib ... [LABELS ...]
#     [SLOW Suite.Case ...] [RECORDINGS Suite.Case ...]
#     [PRECOMPILE <header> ... | REUSE_PRECOMPILED other_test] [HAS_ORACLES])
# SLOW: patterns of GoogleTest; what they match runs as NAME.slow, with the label slow.
# RECORDINGS: what they match needs HGMM_DATA_DIR, and is reported as skipped without.
# HAS_ORACLES: the tests themselves compute much, and are optimised in sanitized builds, too.
function(hgmm_test NAME)
    cmake_parse_arguments(ARG "HAS_ORACLES" "REUSE_PRECOMPILED"
        "SOURCES;LIBRARIES;LABELS;PRECOMPILE;SLOW;RECORDINGS" ${ARGN})
    add_executable(${NAME} ${ARG_SOURCES})
    # What tests call is what must be defined; checks in the tests themselves, most of whose
    # code is GoogleTest's and Eigen's, would double the time that they take to compile.
    hgmm_target(${NAME} SANITIZERS address)
    # What is optimised is what they call; optimised fully, they take twice as long to compile.
    target_compile_options(${NAME} PRIVATE $<$<CONFIG:Release>:-O1>)
    if(HGMM_SANITIZE AND NOT ARG_HAS_ORACLES)
        target_compile_options(${NAME} PRIVATE -O0)
    endif()
    target_link_libraries(${NAME} PRIVATE ${ARG_LIBRARIES} GTest::gtest GTest::gtest_main)
    if(HGMM_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
        # std::regex trips a false alarm of GCC 12 under the sanitizers (GCC bug 105562).
        target_compile_options(${NAME} PRIVATE -Wno-maybe-uninitialized)
    endif()
    if(ARG_REUSE_PRECOMPILED)
        hgmm_precompile(${NAME} REUSE_FROM ${ARG_REUSE_PRECOMPILED})
    else()
        hgmm_precompile(${NAME} <gtest/gtest.h> <filesystem> <fstream> <sstream> ${ARG_PRECOMPILE})
    endif()
    set_target_properties(${NAME} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
    if(HGMM_TEST_PROCESSES EQUAL 0)
        gtest_discover_tests(${NAME} DISCOVERY_MODE PRE_TEST
            PROPERTIES LABELS "${ARG_LABELS}" SKIP_REGULAR_EXPRESSION "SKIPPED")
        return()
    endif()
    list(JOIN ARG_SLOW ":" SLOW)
    list(JOIN ARG_RECORDINGS ":" RECORDINGS)
    hgmm_test_shares(${NAME} ${NAME} "-${SLOW}:${RECORDINGS}" ${HGMM_TEST_PROCESSES} "${ARG_LABELS}")
    if(SLOW)
        hgmm_test_shares(${NAME}.slow ${NAME} "${SLOW}" 2 "${ARG_LABELS};slow")
    endif()
    if(RECORDINGS)
        hgmm_test_shares(${NAME}.recordings ${NAME} "${RECORDINGS}" 1 "${ARG_LABELS};recordings"
            # Without a semicolon, which would end an argument.
            sh -c "test -n \"$HGMM_DATA_DIR\" && exec \"$0\" \"$@\" || exit 77")
    endif()
endfunction()

# hgmm_test_shares(NAME PROGRAM FILTER COUNT LABELS [command...]): cases that a filter of
# GoogleTest lets through, in COUNT processes, started by the command if there is one.
function(hgmm_test_shares NAME PROGRAM FILTER COUNT LABELS)
    math(EXPR LAST "${COUNT} - 1")
    foreach(SHARE RANGE ${LAST})
        add_test(NAME ${NAME}.${SHARE}
            COMMAND ${ARGN} $<TARGET_FILE:${PROGRAM}> --gtest_filter=${FILTER} --gtest_brief=1)
        set_tests_properties(${NAME}.${SHARE} PROPERTIES LABELS "${LABELS}" SKIP_RETURN_CODE 77
            ENVIRONMENT "GTEST_TOTAL_SHARDS=${COUNT};GTEST_SHARD_INDEX=${SHARE}")
    endforeach()
endfunction()
