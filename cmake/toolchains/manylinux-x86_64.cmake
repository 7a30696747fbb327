# Linux with glibc 2.28 (of 2018) and later on x86-64, with Zig's compiler, for wheels. tools/build_libraries.sh
# manylinux-x86_64 builds the libraries. The C++ library is linked statically.

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_SKIP_RPATH ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(zig_target x86_64-linux-gnu.2.28)
set(zig_libraries manylinux-x86_64)
include(${CMAKE_CURRENT_LIST_DIR}/zig.cmake)
