# The install tree: bin/mullion, lib/mullion/{mullion-host,plugins/}, headers, and the CMake package with which an
# outside module is built (examples/minimal_module shows how).
include(CMakePackageConfigHelpers)

install(TARGETS mullion_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS mullion_host RUNTIME DESTINATION ${CMAKE_INSTALL_LIBDIR}/mullion)
install(TARGETS mullion EXPORT mullion_targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS mullion_sdk mullion_coupling EXPORT mullion_targets)
install(DIRECTORY framework/sdk/include/ framework/coupling/include/ ${CMAKE_BINARY_DIR}/generated/include/
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
# The case that `mullion transfer-test` runs: beside the executable in the build tree as in the install tree.
configure_file(${PROJECT_SOURCE_DIR}/configs/transfer_test.toml ${CMAKE_BINARY_DIR}/share/mullion/transfer_test.toml
               COPYONLY)
install(FILES configs/transfer_test.toml DESTINATION ${CMAKE_INSTALL_DATADIR}/mullion)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/mullion)
install(EXPORT mullion_targets NAMESPACE mullion:: DESTINATION ${package_dir})
configure_package_config_file(cmake/mullionConfig.cmake.in ${CMAKE_BINARY_DIR}/mullionConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/mullionConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/mullionConfig.cmake ${CMAKE_BINARY_DIR}/mullionConfigVersion.cmake
              cmake/MullionPlugins.cmake DESTINATION ${package_dir})
