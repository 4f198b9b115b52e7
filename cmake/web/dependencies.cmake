# What the web page builds on: Debian's headers, by single links, since /usr/include as a whole has another system's; zstd,
# whose sources are compiled with the rest; and what stands for libraries and headers that emscripten lacks.
set(web_include ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${web_include})
foreach(headers glm flatbuffers nlohmann)
  if(NOT EXISTS /usr/include/${headers})
    message(FATAL_ERROR "/usr/include/${headers} is missing: cmake/install_packages.sh packages_web.txt")
  endif()
  file(CREATE_LINK /usr/include/${headers} ${web_include}/${headers} SYMBOLIC)
endforeach()

add_library(glm::glm INTERFACE IMPORTED)
add_library(flatbuffers_headers INTERFACE)
add_library(nlohmann_json::nlohmann_json INTERFACE IMPORTED)
add_library(Threads::Threads INTERFACE IMPORTED)
foreach(headers glm::glm flatbuffers_headers nlohmann_json::nlohmann_json)
  target_include_directories(${headers} SYSTEM INTERFACE ${web_include})
endforeach()

add_library(TBB::tbb INTERFACE IMPORTED)
target_include_directories(TBB::tbb SYSTEM INTERFACE ${CMAKE_CURRENT_LIST_DIR}/include)

add_library(PkgConfig::epoxy INTERFACE IMPORTED)
target_include_directories(PkgConfig::epoxy SYSTEM INTERFACE ${CMAKE_CURRENT_LIST_DIR}/include)

set(zstd_folder ${PROJECT_BINARY_DIR}/zstd)
execute_process(COMMAND ${CMAKE_CURRENT_LIST_DIR}/zstd_source.sh ${zstd_folder} RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "the source of zstd cannot be fetched")
endif()
enable_language(C)
file(GLOB zstd_sources ${zstd_folder}/lib/common/*.c ${zstd_folder}/lib/compress/*.c ${zstd_folder}/lib/decompress/*.c)
add_library(zstd STATIC ${zstd_sources})
target_include_directories(zstd SYSTEM INTERFACE ${zstd_folder}/lib)
target_compile_definitions(zstd PRIVATE ZSTD_DISABLE_ASM)
add_library(zstd::libzstd_shared ALIAS zstd)

find_program(FLATC flatc REQUIRED NO_CMAKE_FIND_ROOT_PATH)

# Without SLP: emscripten 3.1.6 makes wrong code of `CameraController::dolly` with it and these vectors.
add_compile_options(-fexceptions -msimd128 -fno-slp-vectorize)
add_link_options(-fexceptions)
add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-include ${CMAKE_CURRENT_LIST_DIR}/include/web_compatibility.h>")

# Debian's node finds the packages of emscripten's own scripts only so.
set_property(GLOBAL PROPERTY RULE_LAUNCH_LINK "env NODE_PATH=/usr/share/nodejs")
