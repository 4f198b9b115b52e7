# Every library that the project builds on, found in one place. Debian 12's packages are listed in `cmake/packages*.txt`.
find_package(Threads REQUIRED)
find_package(glm REQUIRED)
find_package(TBB REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(zstd REQUIRED)
find_package(PNG REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(glfw3 REQUIRED)

# pkg-config rather than find_package: the CMake package of Debian 12 names include folders that are not installed.
find_package(PkgConfig REQUIRED)
pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(imgui REQUIRED IMPORTED_TARGET imgui)
pkg_check_modules(OpenEXR REQUIRED IMPORTED_TARGET OpenEXR)
# It says -pthread, which changes nothing but whether precompiled headers fit.
set_property(TARGET PkgConfig::OpenEXR PROPERTY INTERFACE_COMPILE_OPTIONS "")
# Without them the window records PNG files, and framelet-client makes no films.
pkg_check_modules(libav_film IMPORTED_TARGET libavformat libavcodec libavutil libswscale)

find_program(FLATC flatc REQUIRED)
find_path(FLATBUFFERS_INCLUDE flatbuffers/flatbuffers.h REQUIRED)
add_library(flatbuffers_headers INTERFACE)
target_include_directories(flatbuffers_headers SYSTEM INTERFACE ${FLATBUFFERS_INCLUDE})

if(FRAMELET_SERVER)
  find_package(assimp REQUIRED)
  find_package(draco REQUIRED)
  find_package(meshoptimizer REQUIRED)
  find_package(embree 4 QUIET)
  if(NOT embree_FOUND)
    find_package(embree 3.13 REQUIRED)
  endif()
  message(STATUS "Embree ${embree_VERSION}")
  pkg_check_modules(OpenImageIO REQUIRED IMPORTED_TARGET OpenImageIO)
  pkg_check_modules(utf8proc REQUIRED IMPORTED_TARGET libutf8proc)
  set_property(TARGET PkgConfig::utf8proc PROPERTY INTERFACE_COMPILE_OPTIONS "") # as with OpenEXR
endif()
