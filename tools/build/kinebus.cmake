# How every target of Kinebus is built. Targets are layers: a library lists the layers it may include, so an
# include of a layer that is not linked does not compile (include_roots.cmake).
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Asserts stay on in release: a program that is wrong must stop, not go on. (CMake's own defaults define NDEBUG.)
if(KINEBUS_FIRMWARE AND KINEBUS_CORE)  # small chips, where size counts
  set(CMAKE_CXX_FLAGS_RELEASE "-Os -fno-move-loop-invariants -fno-tree-ch -g1 -fstack-usage -fcallgraph-info=su")
elseif(KINEBUS_FIRMWARE)
  set(CMAKE_CXX_FLAGS_RELEASE "-O2 -g1 -fstack-usage -fcallgraph-info=su")
else()
  set(CMAKE_CXX_FLAGS_RELEASE "-O2")
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
endif()

# Compiled once by Debian: as headers alone it would be compiled again with every file that prints.
if(NOT KINEBUS_FIRMWARE)
  find_library(FMT_LIBRARY fmt REQUIRED)
endif()

find_program(CCACHE ccache)
if(CCACHE)
  # Every clone and build folder shares the compiler's results: paths count from the clone's own root.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
    ${CCACHE})
endif()

add_library(kinebus_options INTERFACE)
target_compile_options(kinebus_options INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Werror
  # clang's -Wconversion holds more than g++'s.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>
  # Identical arithmetic on every platform and build: no fused multiply-add behind our back.
  -ffp-contract=off
  # g++ 12 warns falsely of overlap in "text" + std::string.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(KINEBUS_SANITIZE)
  target_compile_options(kinebus_options INTERFACE -fsanitize=${KINEBUS_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  target_link_options(kinebus_options INTERFACE -fsanitize=${KINEBUS_SANITIZE})
endif()
if(KINEBUS_FUZZ STREQUAL "COMPARISONS")  # finds magic numbers by itself; tests take twice as long with it
  target_compile_options(kinebus_options INTERFACE -fsanitize=fuzzer-no-link)
elseif(KINEBUS_FUZZ)
  target_compile_options(kinebus_options INTERFACE
    $<$<NOT:$<BOOL:$<TARGET_PROPERTY:KINEBUS_TEST>>>:-fsanitize-coverage=inline-8bit-counters,pc-table>)
endif()

# Files of one target are compiled several at a time: a file of 100 lines costs what its headers cost, and they are read
# once a batch. So two files of a target must not define one name in their anonymous namespaces. OFF: one command a file,
# as clang-tidy and editors want it, and as the firmware is built. EACH (kinebus_library): this target has few, heavy files.
option(KINEBUS_UNITY "Compile the files of a target in batches" ON)
function(kinebus_batches target size)
  if(KINEBUS_UNITY AND NOT KINEBUS_FIRMWARE)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${size})
  endif()
endfunction()

# kinebus_library(NAME [EACH] [FAST] SOURCES a.cpp ... LINK layer ...)
# FAST: what planning and streaming spend their time in (one eighth less). The arithmetic stays the same, to the bit.
# Phases and spans are structs of some 300 bytes, which GCC otherwise copies and clears by rep movs and rep stos: a
# twelfth of the time of planning. Editors' clang, which wants one command a file, does not know these words.
set(KINEBUS_FAST -O3 -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64" AND KINEBUS_UNITY)
  list(APPEND KINEBUS_FAST -mmemcpy-strategy=vector_loop:1024:noalign,libcall:-1:noalign
       -mmemset-strategy=vector_loop:1024:noalign,libcall:-1:noalign)
endif()
function(kinebus_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "EACH;FAST" "" "SOURCES;LINK")
  if(arg_SOURCES)
    add_library(${name} STATIC ${arg_SOURCES})
    if(NOT arg_EACH)
      kinebus_batches(${name} 10)
    endif()
    target_link_libraries(${name} PUBLIC kinebus_options ${arg_LINK})
    if(arg_FAST)
      target_compile_options(${name} PRIVATE "$<$<CONFIG:Release>:${KINEBUS_FAST}>")
    endif()
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE kinebus_options ${arg_LINK})
  endif()
endfunction()

# A cross-build has no installed GoogleTest for its target: Debian's source package is built along.
if(CMAKE_CROSSCOMPILING AND NOT KINEBUS_FIRMWARE AND EXISTS /usr/src/googletest/CMakeLists.txt)
  set(INSTALL_GTEST OFF)
  add_subdirectory(/usr/src/googletest ${CMAKE_BINARY_DIR}/googletest EXCLUDE_FROM_ALL)
endif()

# Who only builds the programs need not have the libraries of the tests: then there are no tests, and it is said so.
if(NOT CMAKE_CROSSCOMPILING AND NOT KINEBUS_FIRMWARE)
  find_package(GTest QUIET)
  find_package(benchmark QUIET)
  if(NOT GTest_FOUND OR NOT benchmark_FOUND)
    message(STATUS "Tests and benchmarks are left out: GoogleTest or Google Benchmark is missing (tools/setup test)")
  endif()
endif()

# What is built and run on arm64, under an emulator that stands in for the board: what computes and what is on the wire. The
# rest is the same C++ there, but that a plain char has no sign: so it has none under the address sanitizer either, where all
# core tests run. That whole machines move alike on both is told by their traces (tools/check/same_traces).
set(KINEBUS_ON_ARM64 protocol_test node_motion_test node_test heat_test motor_test step_test kinebus_kinematics_test
  kinebus_motion_test kinebus_shaping_test kinebus_stream_test kinebus_calibration_test)
set(KINEBUS_EMULATION_ARGUMENTS_heat_test --gtest_filter=-Watch.*:Unmeasured.*)

# Tests of what has threads, labelled so: what the thread sanitizer builds and runs, with the daemon itself under printcore.
set(KINEBUS_THREADED_TESTS streams_test job_store_test job_link_test kinebus_workspace_test kinebus_campaign_test)
# Of the campaign one kind of fault is enough: its seeds share the work as all others do, and each has a machine of its own.
set(KINEBUS_TSAN_ARGUMENTS_kinebus_campaign_test --gtest_filter=*frames_dropped)
set(KINEBUS_TSAN_ARGUMENTS_job_store_test --gtest_filter=ReadAhead.*)
add_custom_target(kinebus_threaded_tests)

# With the address sanitizer and what counts for fuzzing this one takes ten minutes: several processes share its tests.
set(KINEBUS_ASAN_SHARDS_machine_test 4)
# What looks at fifty healthy hot ends looks at the same code as what looks at faulty ones.
set(KINEBUS_ASAN_ARGUMENTS_heat_test --gtest_filter=-Watch.All*:Watch.Nothing*:Unmeasured.HotEnds*:Unmeasured.Nothing*)
# Of what is interrupted at many moments the first is enough there: the code is the same.
set(KINEBUS_ASAN_ARGUMENTS_machine_test --gtest_filter=-Seconds/*/1:Seconds/*/2:Seconds/*/3:Seconds/*/4:Seconds/*/5:Seconds/*/6:Seconds/*/7:Resume.GatewayAfterGateway*)

# All tests labelled core: what the address sanitizer builds, and arm64 of them what is listed above.
add_custom_target(kinebus_core_tests)

# A limit is for a test that hangs, not for a busy machine: ctest waits so many times what a test is given.
set(KINEBUS_TEST_PATIENCE 4)

# kinebus_test_limit(SECONDS NAME...): what these tests may take on a quiet computer of two cores. In a fresh build those
# that may take long begin first, so that no core waits for the last of them.
function(kinebus_test_limit seconds)
  math(EXPR limit "${seconds} * ${KINEBUS_TEST_PATIENCE}")
  set_tests_properties(${ARGN} PROPERTIES TIMEOUT ${limit} COST ${seconds})
endfunction()

# kinebus_test(NAME SOURCES a_test.cpp ... LINK layer ... [LABELS core] [TIMEOUT s]): one GoogleTest program; TIMEOUT as
# for kinebus_test_limit.
# The label "core" marks the tests that also run under the address sanitizer, and some of them on arm64.
function(kinebus_test name)
  if(KINEBUS_FIRMWARE)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "TIMEOUT" "SOURCES;LINK;LABELS")
  if(CMAKE_CROSSCOMPILING)
    # RapidCheck is a compiled library that Debian has for the host only: those tests run on the host alone.
    if(NOT name IN_LIST KINEBUS_ON_ARM64 OR "rapidcheck" IN_LIST arg_LINK OR "rapidcheck_gtest" IN_LIST arg_LINK)
      return()
    endif()
  elseif(NOT GTest_FOUND)
    return()
  endif()
  add_executable(${name} ${arg_SOURCES})
  kinebus_batches(${name} 6)
  target_link_libraries(${name} PRIVATE ${arg_LINK} kinebus_options GTest::gtest GTest::gtest_main)
  # What fails is named from the clone's root, so that each clone can share what another has compiled.
  target_compile_options(${name} PRIVATE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
  if(KINEBUS_FUZZ)
    # Half of what this build takes is tests: they need not guide a fuzzer, and gtest names their lines.
    set_target_properties(${name} PROPERTIES KINEBUS_TEST ON)
    target_compile_options(${name} PRIVATE -g0)
  endif()
  if(CMAKE_CROSSCOMPILING)
    set(arguments ${KINEBUS_EMULATION_ARGUMENTS_${name}})
  elseif(KINEBUS_SANITIZE STREQUAL "thread")
    set(arguments ${KINEBUS_TSAN_ARGUMENTS_${name}})
  elseif(KINEBUS_SANITIZE)
    set(arguments ${KINEBUS_ASAN_ARGUMENTS_${name}})
  endif()
  set(tests ${name})
  if(KINEBUS_FUZZ AND KINEBUS_ASAN_SHARDS_${name})
    set(tests "")
    foreach(shard RANGE 1 ${KINEBUS_ASAN_SHARDS_${name}})
      list(APPEND tests ${name}_${shard})
    endforeach()
  endif()
  set(shard 0)
  foreach(test ${tests})
    add_test(NAME ${test} COMMAND ${name} ${arguments})
    if(NOT test STREQUAL name)
      set_tests_properties(${test} PROPERTIES ENVIRONMENT
        "GTEST_TOTAL_SHARDS=${KINEBUS_ASAN_SHARDS_${name}};GTEST_SHARD_INDEX=${shard}")
      math(EXPR shard "${shard} + 1")
    endif()
  endforeach()
  if(NOT arg_LABELS)
    set(arg_LABELS core)
  endif()
  if(name IN_LIST KINEBUS_THREADED_TESTS)
    list(APPEND arg_LABELS threads)
    add_dependencies(kinebus_threaded_tests ${name})
  endif()
  set_tests_properties(${tests} PROPERTIES LABELS "${arg_LABELS}")
  if(arg_TIMEOUT)
    kinebus_test_limit(${arg_TIMEOUT} ${tests})
  else()
    kinebus_test_limit(300 ${tests})
    set_tests_properties(${tests} PROPERTIES COST 10)
  endif()
  if("core" IN_LIST arg_LABELS)
    add_dependencies(kinebus_core_tests ${name})
  endif()
endfunction()

# kinebus_fuzz(NAME SOURCES x_fuzz.cpp LINK layer ...): a libFuzzer program, only in the asan preset, whose libraries are
# built for fuzzing, too. Its corpus is the folder corpus/NAME beside the source.
add_custom_target(kinebus_fuzz_targets)
function(kinebus_fuzz name)
  if(NOT KINEBUS_FUZZ)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LINK")
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LINK} kinebus_options)
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  add_dependencies(kinebus_fuzz_targets ${name})
endfunction()

# kinebus_bench(NAME SOURCES x_bench.cpp LINK layer ...): a Google Benchmark program, run by tools/bench.
function(kinebus_bench name)
  if(KINEBUS_FIRMWARE OR KINEBUS_SANITIZE OR CMAKE_CROSSCOMPILING)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LINK")
  if(NOT benchmark_FOUND)
    return()
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LINK} kinebus_options benchmark::benchmark benchmark::benchmark_main)
endfunction()
