# cmake --install, and what find_package(locograph) reads afterwards.
include(CMakePackageConfigHelpers)
set(locograph_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/locograph)
install(EXPORT locographTargets NAMESPACE locograph:: DESTINATION ${locograph_config_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/locographConfig.cmake.in
  ${PROJECT_BINARY_DIR}/locographConfig.cmake INSTALL_DESTINATION ${locograph_config_dir}
  PATH_VARS CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/locographConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/locographConfig.cmake
              ${PROJECT_BINARY_DIR}/locographConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindMETIS.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindCHOLMOD.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindMuJoCo.cmake
              ${PROJECT_SOURCE_DIR}/cmake/LocographPlugin.cmake
              ${PROJECT_SOURCE_DIR}/cmake/hide_eigen.map
        DESTINATION ${locograph_config_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(LOCOGRAPH_PLANNING)
  # Where programs look for it: common/data_folder.h.
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/robots/models
          DESTINATION ${CMAKE_INSTALL_DATADIR}/locograph/robots)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/planners/scenarios
          DESTINATION ${CMAKE_INSTALL_DATADIR}/locograph)
endif()
