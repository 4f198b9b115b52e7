# The standard library, glm and GoogleTest, which most files include, are parsed once for all files with the same flags. What
# fewer include is not among them: every file pays for the size of what is precompiled. A file must still include all it uses:
# the preset `debug` and `./test tidy` do without this, and so does clang with ccache, which go badly together.
if(NOT FRAMELET_PRECOMPILE OR (uses_ccache AND NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU"))
  return()
endif()

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # It warns of std::string's own copies, wrongly (its bugs 105329 and 105651).
  target_compile_options(framelet_options INTERFACE
    -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
endif()

set(usual_headers
  <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <functional> <memory> <mutex> <optional> <ostream> <span>
  <string> <unordered_map> <variant> <vector> <glm/geometric.hpp> <glm/gtc/quaternion.hpp>)

# Owners: whoever takes their headers must have their flags and may define more macros, none fewer.
target_precompile_headers(framelet_common PRIVATE ${usual_headers})
if(TARGET framelet_test_headers)
  target_precompile_headers(framelet_test_headers PRIVATE ${usual_headers} <numeric> <random> <gtest/gtest.h>)
endif()

# All other targets in a folder and below.
function(framelet_precompile folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    get_target_property(own ${target} PRECOMPILE_HEADERS)
    if(own OR NOT type MATCHES "^(STATIC_LIBRARY|EXECUTABLE)$")
      continue()
    elseif(target MATCHES "_test$")
      target_precompile_headers(${target} REUSE_FROM framelet_test_headers)
    else()
      target_precompile_headers(${target} REUSE_FROM framelet_common)
    endif()
  endforeach()
  get_property(subfolders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(subfolder IN LISTS subfolders)
    framelet_precompile(${subfolder})
  endforeach()
endfunction()

framelet_precompile(${PROJECT_SOURCE_DIR})
