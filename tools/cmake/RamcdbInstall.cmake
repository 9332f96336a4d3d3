# Installs the libraries, the public headers and a CMake package: find_package(ramcdb), then link ramcdb::ramcdb.
# The folder libraries are static and private; they are exported because the public one is made of them.
include(CMakePackageConfigHelpers)

target_compile_features(ramcdb_vocabulary INTERFACE cxx_std_20)
foreach(folder vocabulary codec chartify db mesh_file)
  set_target_properties(ramcdb_${folder} PROPERTIES EXPORT_NAME ${folder})
endforeach()
add_library(ramcdb::ramcdb ALIAS ramcdb) # the name that works with add_subdirectory too

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/ramcdb)
install(TARGETS ramcdb_vocabulary ramcdb_codec ramcdb_chartify ramcdb_db ramcdb_mesh_file ramcdb EXPORT ramcdbTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/api/include/ramcdb DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN *.h)
install(EXPORT ramcdbTargets NAMESPACE ramcdb:: DESTINATION ${package_folder})

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/ramcdbConfig.cmake.in ${PROJECT_BINARY_DIR}/ramcdbConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ramcdbConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ramcdbConfig.cmake ${PROJECT_BINARY_DIR}/ramcdbConfigVersion.cmake
        DESTINATION ${package_folder})
