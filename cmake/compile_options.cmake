# One interface target that every target of this project links privately: language, warnings, sanitizers.
# It is never exported: nothing here reaches a consumer.

add_library(lamella_options INTERFACE)
target_compile_features(lamella_options INTERFACE cxx_std_20)
target_compile_options(
    lamella_options
    INTERFACE -Wall
              -Wextra
              -Wpedantic
              -Wshadow
              -Wconversion
              -Wno-sign-conversion
              -Wnon-virtual-dtor
              -Woverloaded-virtual
              # The same bits on every processor: a*b+c is never fused (docs/conventions.md).
              -ffp-contract=off)
# GCC sees uninitialised values in the code that its own sanitizers add: there warnings stay warnings.
if(LAMELLA_WERROR AND NOT (LAMELLA_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU"))
    target_compile_options(lamella_options INTERFACE -Werror)
endif()
if(LAMELLA_SANITIZE)
    target_compile_options(lamella_options INTERFACE -fsanitize=${LAMELLA_SANITIZE} -fno-omit-frame-pointer
                                                     -fno-sanitize-recover=all)
    target_link_options(lamella_options INTERFACE -fsanitize=${LAMELLA_SANITIZE})
endif()
# libFuzzer steers by what it sees reached: the library must tell, not the fuzz targets alone.
if(LAMELLA_FUZZ)
    target_compile_options(lamella_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
