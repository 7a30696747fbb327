# What `cmake --install` lays down, so that find_package(lamella) and pkg-config find it wherever the tree is
# moved.

include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lamella)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(TARGETS lamella EXPORT lamella-targets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lamella DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT lamella-targets NAMESPACE lamella:: DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/LICENSES-third-party.txt
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The pages that headers refer to, with all that they show or link to, in the folders of the sources.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}
        PATTERN CMakeLists.txt EXCLUDE PATTERN __pycache__ EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/bench/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/bench)
install(FILES ${PROJECT_SOURCE_DIR}/tools/packages.txt ${PROJECT_SOURCE_DIR}/tools/packages-test.txt
        DESTINATION ${CMAKE_INSTALL_DOCDIR}/tools)
# PageOptions::viewer: what the program carries in itself. Absent where it could not be built.
if(LAMELLA_VIEWER_HTML)
    install(FILES ${LAMELLA_VIEWER_HTML} DESTINATION ${CMAKE_INSTALL_DATADIR}/lamella RENAME viewer.html OPTIONAL)
endif()

set(pc_packages "expat fmt libdeflate zlib")
# A static library leaves it to its user to link what it needs; a shared one has done so itself.
get_target_property(library_type lamella TYPE)
if(library_type STREQUAL "STATIC_LIBRARY")
    set(LAMELLA_IS_STATIC TRUE)
    set(pc_requires "Requires: ${pc_packages}")
    set(pc_libs "-llamella -pthread")
else()
    set(LAMELLA_IS_STATIC FALSE)
    set(pc_requires "Requires.private: ${pc_packages}")
    set(pc_libs "-llamella\nLibs.private: -pthread")
endif()

configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/cmake/lamella-config.cmake.in ${PROJECT_BINARY_DIR}/lamella-config.cmake
    INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lamella-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lamella-config.cmake ${PROJECT_BINARY_DIR}/lamella-config-version.cmake
        DESTINATION ${package_dir})

file(RELATIVE_PATH pc_to_prefix /prefix/${pkgconfig_dir} /prefix)
configure_file(${PROJECT_SOURCE_DIR}/cmake/lamella.pc.in ${PROJECT_BINARY_DIR}/lamella.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lamella.pc DESTINATION ${pkgconfig_dir})

file(RELATIVE_PATH bin_to_lib /prefix/${CMAKE_INSTALL_BINDIR} /prefix/${CMAKE_INSTALL_LIBDIR})
foreach(program lamella_app lamella_mpi)
    if(BUILD_SHARED_LIBS AND TARGET ${program})
        set_target_properties(${program} PROPERTIES INSTALL_RPATH $ORIGIN/${bin_to_lib})
    endif()
endforeach()
# The component `program` is what goes into a package of it.
if(TARGET lamella_app)
    install(TARGETS lamella_app OPTIONAL COMPONENT program)
endif()
if(TARGET lamella_mpi)
    install(TARGETS lamella_mpi OPTIONAL)
endif()
