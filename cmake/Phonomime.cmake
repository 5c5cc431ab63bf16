# SPDX-License-Identifier: GPL-3.0-or-later
# What every target shares, and the two functions with which each folder declares itself.

set_property(GLOBAL PROPERTY GLOBAL_DEPENDS_NO_CYCLES ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug or RelWithDebInfo" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

find_package(Threads REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)

# The same input gives the same bytes on every machine: no fused multiply-add behind the source's
# back, and no thread count inside Eigen. Libraries that nearly all folders need are here, so that all
# sources are compiled alike and can share precompiled headers.
add_library(phonomime_options INTERFACE)
target_include_directories(phonomime_options INTERFACE ${PROJECT_SOURCE_DIR})
target_link_libraries(phonomime_options INTERFACE Eigen3::Eigen fmt::fmt OpenMP::OpenMP_CXX)
target_compile_options(phonomime_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  -Wno-sign-conversion -Wnon-virtual-dtor -ffp-contract=off
  # Structs have default member values: a designated initialiser may leave members out.
  -Wno-missing-field-initializers
  # g++ 12 warns of overlaps and sizes inside std::string that cannot happen (GCC bug 105651); of the
  # latter where <string> is precompiled.
  "$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-stringop-overflow;-Wno-array-bounds>")
target_compile_definitions(phonomime_options INTERFACE EIGEN_DONT_PARALLELIZE)
if(PHONOMIME_WERROR)
  target_compile_options(phonomime_options INTERFACE -Werror)
endif()
if(PHONOMIME_SANITIZE)
  # With sanitizers g++ 12 takes members of <regex> for uninitialised (GCC bug 105562).
  target_compile_options(phonomime_options INTERFACE -fsanitize=${PHONOMIME_SANITIZE}
    -fno-omit-frame-pointer -fno-sanitize-recover=all
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(phonomime_options INTERFACE -fsanitize=${PHONOMIME_SANITIZE})
endif()

# phonomime_precompiled(NAME header ...): headers of others, precompiled. They take two fifths of the
# time that compiling needs. g++ only: ccache does not keep what clang makes of them. Each source still
# includes what it uses; presets dev and tsan, without precompiled headers, see to that.
function(phonomime_precompiled name)
  if(PHONOMIME_PRECOMPILE)
    add_library(${name} OBJECT ${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp)
    target_link_libraries(${name} PRIVATE phonomime_options)
    target_compile_options(${name} PRIVATE -fpch-preprocess)
    target_precompile_headers(${name} PRIVATE ${ARGN})
  endif()
endfunction()

# phonomime_reuse(TARGET NAME): the target's sources start from the precompiled headers NAME.
function(phonomime_reuse target name)
  if(PHONOMIME_PRECOMPILE)
    target_compile_options(${target} PRIVATE -fpch-preprocess)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()

if(NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  set(PHONOMIME_PRECOMPILE OFF)
endif()
set(common_headers <algorithm> <array> <atomic> <cmath> <cstddef> <cstdint> <cstring> <exception>
  <filesystem> <fstream> <functional> <iterator> <limits> <map> <memory> <mutex> <numbers> <numeric>
  <optional> <set> <span> <sstream> <string> <string_view> <system_error> <tuple> <unordered_map>
  <utility> <variant> <vector> <fmt/format.h> <fmt/ranges.h> <Eigen/Core> <Eigen/Geometry>)
phonomime_precompiled(phonomime_common_headers ${common_headers})

# phonomime_library(NAME SOURCES a.cpp ... [LINKS lib ...]): the static library of one folder.
function(phonomime_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC phonomime_options ${ARG_LINKS})
  phonomime_reuse(${name} phonomime_common_headers)
endfunction()

# phonomime_test(NAME SOURCES a_test.cpp ... [LINKS lib ...] [LABELS l ...]): one GoogleTest program.
# ctest runs it whole; a test that needs ../shared asks tests/support for it and skips itself.
# Labels: asan, tsan (the sanitizer under which tools/check runs it). Target check_<label> builds all
# that the tests of a label need.
function(phonomime_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE phonomime_options phonomime_test_support GTest::gtest_main
    ${ARG_LINKS})
  phonomime_reuse(${name} phonomime_test_headers)
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 900)
  foreach(label IN LISTS ARG_LABELS)
    phonomime_check_needs(${label} ${name})
  endforeach()
endfunction()

# phonomime_check_needs(LABEL target ...): tests of the label that are no phonomime_test need these.
function(phonomime_check_needs label)
  if(NOT TARGET check_${label})
    add_custom_target(check_${label})
  endif()
  add_dependencies(check_${label} ${ARGN})
endfunction()
