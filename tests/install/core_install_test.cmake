include(${CMAKE_CURRENT_LIST_DIR}/step.cmake)

# The core alone, found by another project that knows nothing of MRPT.
file(REMOVE_RECURSE ${WORK_DIR})
step(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
step(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/core_consumer -B ${WORK_DIR}/build -G Ninja
    -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCMAKE_CXX_COMPILER=${CXX})
step(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
step(${WORK_DIR}/build/consumer-core)
if(NOT STEP_OUTPUT MATCHES "consumer-core: [1-9][0-9]* component")
    message(FATAL_ERROR "consumer-core printed: ${STEP_OUTPUT}")
endif()
step(ldd ${WORK_DIR}/build/consumer-core)
if(STEP_OUTPUT MATCHES "mrpt" OR NOT STEP_OUTPUT MATCHES "${WORK_DIR}/prefix/[^ ]*libhgmm")
    message(FATAL_ERROR "consumer-core needs:\n${STEP_OUTPUT}")
endif()
file(GLOB_RECURSE FOREIGN ${WORK_DIR}/prefix/*mrpt/* ${WORK_DIR}/prefix/*libmrpt*)
if(FOREIGN)
    message(FATAL_ERROR "installed with the core: ${FOREIGN}")
endif()

# The README's program, compiled by hand: no package, no generated header.
file(READ ${SOURCE_DIR}/README.md PAGE)
if(NOT PAGE MATCHES "```cpp\n([^`]*)```")
    message(FATAL_ERROR "README.md has no C++ program")
endif()
file(WRITE ${WORK_DIR}/x.cpp "${CMAKE_MATCH_1}")
step(${CXX} -std=c++17 -I${SOURCE_DIR}/libs/hgmm/include -I${EIGEN_DIR} ${WORK_DIR}/x.cpp
    -o ${WORK_DIR}/x -L${BUILD_DIR}/lib -Wl,-rpath,${BUILD_DIR}/lib -lhgmm)
step(${WORK_DIR}/x)
if(NOT STEP_OUTPUT MATCHES "^occupied 0\\.[0-9]+, free (0\\.[5-9][0-9]*|1\\.0+), unknown 0\\.[0-9]+\n$")
    message(FATAL_ERROR "the README's program printed: ${STEP_OUTPUT}")
endif()
