# WebAssembly, with Debian's Emscripten. tools/build_libraries.sh wasm builds the libraries.

set(EMSCRIPTEN_ROOT_PATH /usr/share/emscripten)
include(${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake)
set(libraries ${CMAKE_CURRENT_LIST_DIR}/../../build/libraries/wasm)
list(PREPEND CMAKE_FIND_ROOT_PATH ${libraries})

# Vectors, threads, and exceptions that cost nothing until they are thrown.
set(flags "-pthread -msimd128 -fwasm-exceptions")
set(CMAKE_C_FLAGS_INIT "${flags}")
set(CMAKE_CXX_FLAGS_INIT "${flags}")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-L${libraries}/lib")

# Clang 15 makes wrong code where it turns operations into vectors by itself: the last vertex of a rotated mesh was elsewhere
# (tests/web/package_test.mjs, "rotated meshes"). Vectors that the sources ask for remain. These options count only behind
# that of the optimisation.
add_compile_options(-fno-vectorize -fno-slp-vectorize)
