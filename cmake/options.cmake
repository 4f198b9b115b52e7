# Compiler settings that every target of the project shares.
add_library(framelet_options INTERFACE)
configure_file(${CMAKE_CURRENT_LIST_DIR}/version.h.in ${PROJECT_BINARY_DIR}/generated/framelet_version.h @ONLY)
target_include_directories(framelet_options INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/generated)
target_compile_options(framelet_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wold-style-cast -Wnon-virtual-dtor
  -Woverloaded-virtual -Werror
  # No code relies on the value of errno, on trapping or on the sign of zero; NaN and infinity keep their meaning.
  -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # GCC's own pragmas, such as ivdep; what GCC, with which one works, does not count as a conversion.
  target_compile_options(framelet_options INTERFACE -Wno-unknown-pragmas -Wno-sign-conversion)
endif()
if(FRAMELET_NATIVE)
  target_compile_options(framelet_options INTERFACE -march=native)
elseif(FRAMELET_PROCESSOR)
  target_compile_options(framelet_options INTERFACE -march=${FRAMELET_PROCESSOR})
endif()
if(FRAMELET_SANITIZE)
  add_compile_options(-fsanitize=${FRAMELET_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${FRAMELET_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    add_compile_options(-fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/cmake/not_checked.txt)
  endif()
endif()
target_link_libraries(framelet_options INTERFACE glm::glm Threads::Threads)

# For files that do no more than read a command line, once: CLI11's templates keep the optimiser busy for several seconds a
# file.
function(framelet_reads_command_line)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O1>)
endfunction()

find_program(CCACHE ccache)
set(uses_ccache OFF)
if(CCACHE AND NOT DEFINED ENV{CCACHE_DISABLE})
  set(uses_ccache ON)
  # Precompiled headers are looked for in the cache only with these two told; no file uses __TIME__ or the like. What a file
  # includes is taken from the compiler: to preprocess it first costs a tenth of the build.
  set_property(GLOBAL PROPERTY RULE_LAUNCH_COMPILE "env CCACHE_DEPEND=1 CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE}")
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(framelet_options INTERFACE -fpch-preprocess) # for the same reason
  endif()
endif()
