# NOT RUN: an overlay port of this checkout, without a download:
#   vcpkg install wingbeat --overlay-ports=packaging/vcpkg
# What CMake installs is what the package libwingbeat-dev holds, which scripts/check-packages uses.
vcpkg_check_linkage(ONLY_STATIC_LIBRARY)
get_filename_component(SOURCE_PATH "${CURRENT_PORT_DIR}/../../.." ABSOLUTE)
vcpkg_check_features(OUT_FEATURE_OPTIONS FEATURES FEATURES
  library WINGBEAT_LIBRARY
  program WINGBEAT_PROGRAM
)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS ${FEATURES} -DWINGBEAT_TESTS=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME wingbeat CONFIG_PATH lib/cmake/wingbeat)
vcpkg_copy_pdbs()
if("program" IN_LIST FEATURES)
  vcpkg_copy_tools(TOOL_NAMES wingbeat AUTO_CLEAN)
endif()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
