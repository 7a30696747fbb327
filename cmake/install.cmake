# Installs the libraries so that find_package(lamella) and pkg-config find them wherever the tree is moved.

include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lamella)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(TARGETS lamella EXPORT lamella-targets)
install(TARGETS lamella-io EXPORT lamella-io-targets)
if(TARGET lamella-c)
    install(TARGETS lamella-c EXPORT lamella-c-targets)
    install(EXPORT lamella-c-targets NAMESPACE lamella:: DESTINATION ${package_dir})
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lamella DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT lamella-targets NAMESPACE lamella:: DESTINATION ${package_dir})
install(EXPORT lamella-io-targets NAMESPACE lamella:: DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/LICENSES-third-party.txt
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The pages that headers refer to, with all files they show or link to, in the folders of the sources.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}
        PATTERN CMakeLists.txt EXCLUDE PATTERN __pycache__ EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/bench/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/bench)
install(FILES ${PROJECT_SOURCE_DIR}/tools/packages.txt ${PROJECT_SOURCE_DIR}/tools/packages-test.txt
        DESTINATION ${CMAKE_INSTALL_DOCDIR}/tools)
# The page for PageOptions::viewer, which the program contains. It is missing if it could not be built.
if(LAMELLA_VIEWER_HTML)
    install(FILES ${LAMELLA_VIEWER_HTML} DESTINATION ${CMAKE_INSTALL_DATADIR}/lamella RENAME viewer.html OPTIONAL)
endif()

# A system without packages of its own gets the libraries that ours need, too.
if(LAMELLA_LIBRARIES)
    install(DIRECTORY ${LAMELLA_LIBRARIES}/include ${LAMELLA_LIBRARIES}/lib ${LAMELLA_LIBRARIES}/share DESTINATION .)
endif()

set(LAMELLA_IS_STATIC FALSE)
if(NOT BUILD_SHARED_LIBS)
    set(LAMELLA_IS_STATIC TRUE)
endif()

configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/cmake/lamella-config.cmake.in ${PROJECT_BINARY_DIR}/lamella-config.cmake
    INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lamella-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lamella-config.cmake ${PROJECT_BINARY_DIR}/lamella-config-version.cmake
        DESTINATION ${package_dir})

# The libraries of C++ that a program in C must link with a static library, by its own linker.
set(runtime ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
list(FILTER runtime INCLUDE REGEX "^(stdc\\+\\+|c\\+\\+|m)$")
list(REMOVE_DUPLICATES runtime)
list(TRANSFORM runtime PREPEND "-l")
list(JOIN runtime " " runtime)

# A program that links a static library must link the library's dependencies, too; a shared library has already linked
# them.
function(lamella_pkgconfig pc_name pc_description)
    cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "LIBRARIES;PACKAGES")
    list(JOIN arg_PACKAGES " " packages)
    list(TRANSFORM arg_LIBRARIES PREPEND "-l")
    list(JOIN arg_LIBRARIES " " libraries)
    if(LAMELLA_IS_STATIC)
        set(pc_requires "Requires: ${packages}")
        set(pc_libs "${libraries} -pthread\nLibs.private: ${runtime}")
    else()
        list(GET arg_LIBRARIES 0 library)
        set(pc_requires "Requires.private: ${packages}")
        set(pc_libs "${library}\nLibs.private: -pthread")
    endif()
    file(RELATIVE_PATH pc_to_prefix /prefix/${pkgconfig_dir} /prefix)
    configure_file(${PROJECT_SOURCE_DIR}/cmake/lamella.pc.in ${PROJECT_BINARY_DIR}/${pc_name}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/${pc_name}.pc DESTINATION ${pkgconfig_dir})
endfunction()
lamella_pkgconfig(lamella "${PROJECT_DESCRIPTION}" LIBRARIES lamella PACKAGES fmt)
lamella_pkgconfig(lamella-io "Files, formats and jobs for Lamella" LIBRARIES lamella-io lamella
                  PACKAGES expat fmt libdeflate zlib)

if(TARGET lamella-c)
    set(pc_name lamella-c)
    set(pc_description "The C interface of Lamella")
    set(pc_requires)
    set(pc_libs -llamella-c)
    file(RELATIVE_PATH pc_to_prefix /prefix/${pkgconfig_dir} /prefix)
    configure_file(${PROJECT_SOURCE_DIR}/cmake/lamella.pc.in ${PROJECT_BINARY_DIR}/lamella-c.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/lamella-c.pc DESTINATION ${pkgconfig_dir})
    if(BUILD_SHARED_LIBS)
        set_target_properties(lamella-c PROPERTIES INSTALL_RPATH $ORIGIN)
    endif()
endif()

file(RELATIVE_PATH bin_to_lib /prefix/${CMAKE_INSTALL_BINDIR} /prefix/${CMAKE_INSTALL_LIBDIR})
foreach(program lamella_app lamella_mpi)
    if(BUILD_SHARED_LIBS AND TARGET ${program})
        set_target_properties(${program} PROPERTIES INSTALL_RPATH $ORIGIN/${bin_to_lib})
    endif()
endforeach()
# The component `program` is the content of a package of the program.
if(TARGET lamella_app)
    install(TARGETS lamella_app OPTIONAL COMPONENT program)
endif()
if(TARGET lamella_mpi)
    install(TARGETS lamella_mpi OPTIONAL)
endif()
