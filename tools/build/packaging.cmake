# Debian packages by `cpack -G DEB`: kinebus-daemon and kinebus-cli (with workspace), and, where their libraries are
# installed, kinebus-gui, kinebus-fleet, kinebus-calibrate and kinebus-compose. Components are named where targets are installed.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME kinebus)
set(CPACK_PACKAGE_CONTACT "The Kinebus developers <kinebus@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL daemon cli)
if(TARGET kinebus-gui)
  list(APPEND CPACK_COMPONENTS_ALL gui)
  set(CPACK_DEBIAN_GUI_PACKAGE_NAME kinebus-gui)
  set(CPACK_COMPONENT_GUI_DESCRIPTION
    "Kinebus desktop program\n Sends jobs to a Kinebus gateway over USB or a local socket and shows the machine as it prints.")
  set(CPACK_DEBIAN_GUI_PACKAGE_RECOMMENDS "kinebus-daemon, fonts-noto-core | fonts-dejavu-core")
endif()
if(TARGET kinebus-fleet)
  list(APPEND CPACK_COMPONENTS_ALL fleet)
  set(CPACK_DEBIAN_FLEET_PACKAGE_NAME kinebus-fleet)
  set(CPACK_COMPONENT_FLEET_DESCRIPTION
    "Kinebus fleet\n One queue of jobs in PostgreSQL for many Kinebus machines; each job is started exactly once.")
  set(CPACK_DEBIAN_FLEET_PACKAGE_SUGGESTS postgresql)
  set(CPACK_DEBIAN_FLEET_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/gateway/fleet/package/postinst")
endif()
if(TARGET kinebus-compose)
  # A package of its own: what it links of CGAL is GPL-3, so this program as a whole is; Kinebus itself is MIT.
  list(APPEND CPACK_COMPONENTS_ALL compose)
  set(CPACK_DEBIAN_COMPOSE_PACKAGE_NAME kinebus-compose)
  set(CPACK_COMPONENT_COMPOSE_DESCRIPTION
    "Kinebus part composer\n Cuts a part so that every piece prints without support, slices the pieces with PrusaSlicer and joins them into one five-axis job. Contains parts of CGAL: distributed under the GPL, version 3.")
  set(CPACK_DEBIAN_COMPOSE_PACKAGE_RECOMMENDS prusa-slicer)
  install(FILES ${PROJECT_SOURCE_DIR}/tools/compose/copyright DESTINATION share/doc/kinebus-compose COMPONENT compose)
endif()
if(TARGET kinebus-calibrate)
  # A package of its own, too: Debian's Ceres is linked with parts of SuiteSparse that are GPL-2 or later.
  list(APPEND CPACK_COMPONENTS_ALL calibrate)
  set(CPACK_DEBIAN_CALIBRATE_PACKAGE_NAME kinebus-calibrate)
  set(CPACK_COMPONENT_CALIBRATE_DESCRIPTION
    "Kinebus calibration\n Rails and geometry of a machine from measurements, residuals as pictures, poses to measure next. Linked with Ceres and SuiteSparse: distributed under the GPL, version 2 or later.")
  install(FILES ${PROJECT_SOURCE_DIR}/tools/calibrate/copyright DESTINATION share/doc/kinebus-calibrate COMPONENT calibrate)
endif()
# The others are MIT.
foreach(component ${CPACK_COMPONENTS_ALL})
  if(NOT component MATCHES "^(compose|calibrate)$")
    install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION share/doc/kinebus-${component} RENAME copyright COMPONENT ${component})
  endif()
endforeach()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION misc)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
if(CMAKE_CROSSCOMPILING)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS OFF)
  # What dpkg-shlibdeps cannot find out of a foreign build: the libraries that the programs name (readelf -d).
  set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "libc6, libdeflate0, libedit2, libfmt9, libgcc-s1, libnlopt0, libprotobuf32, libspdlog1.10, libsqlite3-0, libssl3, libstdc++6, libsystemd0, libxxhash0")
endif()
set(CPACK_DEBIAN_DAEMON_PACKAGE_NAME kinebus-daemon)
set(CPACK_COMPONENT_DAEMON_DESCRIPTION
  "Kinebus gateway daemon\n Plans G-code under joint limits and streams motion to CAN stepper nodes.")
set(CPACK_DEBIAN_DAEMON_PACKAGE_RECOMMENDS kinebus-cli)
set(CPACK_DEBIAN_DAEMON_PACKAGE_PREDEPENDS adduser)
set(CPACK_DEBIAN_DAEMON_PACKAGE_CONTROL_EXTRA
  "${PROJECT_SOURCE_DIR}/gateway/io/package/postinst;${PROJECT_SOURCE_DIR}/gateway/io/package/prerm;${PROJECT_SOURCE_DIR}/gateway/io/package/conffiles")
set(CPACK_DEBIAN_CLI_PACKAGE_NAME kinebus-cli)
set(CPACK_COMPONENT_CLI_DESCRIPTION
  "Kinebus command line\n Commands the gateway daemon, plans and simulates jobs, offers virtual nodes and scans workspaces.")
set(CPACK_DEBIAN_CLI_PACKAGE_SUGGESTS "wireshark, tshark")
include(CPack)
