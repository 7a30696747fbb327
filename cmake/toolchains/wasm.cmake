# WebAssembly, with Debian's Emscripten. tools/build_libraries.sh wasm builds the libraries.

set(EMSCRIPTEN_ROOT_PATH /usr/share/emscripten)
include(${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake)
set(libraries ${CMAKE_CURRENT_LIST_DIR}/../../build/libraries/wasm)
list(PREPEND CMAKE_FIND_ROOT_PATH ${libraries})

# Vectors, and exceptions that cost nothing until they are thrown.
set(CMAKE_C_FLAGS_INIT "-msimd128 -fwasm-exceptions")
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -fwasm-exceptions")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-L${libraries}/lib")
