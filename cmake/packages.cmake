# Debian packages by cpack: what each holds, says of itself and depends on. scripts/build-packages does all of it.
set(DEBIAN_REVISION 1)
set(DEBIAN_DOCUMENTS ${PROJECT_BINARY_DIR}/debian)
find_program(GZIP gzip REQUIRED)
# FMUs of the packaged program run on Windows, too.
if(NOT WINDOWS_COMPILER)
  message(FATAL_ERROR "the package wingbeat holds the binary of FMUs for Windows, for which there is no compiler: "
    "install g++-mingw-w64-x86-64-posix, as scripts/install-dependencies --packages does")
endif()

# The date of the changelog is that of the sources: SOURCE_DATE_EPOCH.
string(TIMESTAMP DEBIAN_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(WINGBEAT_MAINTAINER "the wingbeat authors <wingbeat@users.noreply.github.com>" CACHE STRING
  "Who answers for the packages: name and address")
configure_file(packaging/debian/changelog.in ${DEBIAN_DOCUMENTS}/changelog.Debian @ONLY)
file(READ LICENSE LICENCE_TEXT)
string(REGEX REPLACE "^.*(Redistribution and use)" "\\1" LICENCE_TEXT "${LICENCE_TEXT}")
string(STRIP "${LICENCE_TEXT}" LICENCE_TEXT)
string(REPLACE "\n\n" "\n.\n" LICENCE_TEXT "${LICENCE_TEXT}")
string(REPLACE "\n" "\n " LICENCE_TEXT "${LICENCE_TEXT}")
configure_file(packaging/debian/copyright.in ${DEBIAN_DOCUMENTS}/copyright @ONLY)
configure_file(CHANGELOG.md ${DEBIAN_DOCUMENTS}/changelog COPYONLY)
foreach(text changelog.Debian changelog)
  execute_process(COMMAND ${GZIP} -9nc ${DEBIAN_DOCUMENTS}/${text} OUTPUT_FILE ${DEBIAN_DOCUMENTS}/${text}.gz
    COMMAND_ERROR_IS_FATAL ANY)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program development python3 documentation)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT ${WINGBEAT_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_SOURCE_DIR}/build/packages CACHE PATH "Where cpack writes packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${DEBIAN_REVISION})
set(CPACK_DEBIAN_PACKAGE_SOURCE wingbeat)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS OFF)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(WINGBEAT_DEBIAN_VERSION ${PROJECT_VERSION}-${DEBIAN_REVISION})

# COMPONENT NAME SECTION, then the description: its first line is the summary.
macro(wingbeat_package component name section description)
  string(TOUPPER ${component} COMPONENT)
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_SECTION ${section})
  set(CPACK_COMPONENT_${COMPONENT}_DESCRIPTION ${description})
  foreach(text copyright changelog.Debian.gz changelog.gz)
    install(FILES ${DEBIAN_DOCUMENTS}/${text} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
  endforeach()
endmacro()

wingbeat_package(program wingbeat science
"electromechanical model of flapping-wing micro air vehicles
From a vehicle file wingbeat computes how a motor-driven flapping-wing micro
air vehicle flaps and what that costs: flapping frequency, lift, forces, where
the electrical power goes, waveforms, and, for a design that does not flap,
the reason. A DC motor turns a crank, a rod and slider, a four-bar or any
stroke law from a table, or swings the wings directly; friction in the
transmission grows with the rod force.

It sweeps parameters into NetCDF data sets, finds optimal designs, fits
parameters to bench measurements, identifies motors from data sheets, and
says how uncertain parameters spread and how long a battery lasts. This
package holds the program with its manual pages and example files.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "wingbeat-doc, python3-wingbeat, openmpi-bin")

wingbeat_package(development libwingbeat-dev libdevel
"model of flapping-wing micro air vehicles, development files
The library behind the program wingbeat: steady flapping of a motor-driven
flapping-wing vehicle as a periodic orbit with exact derivatives, simulation
in time, thousands of vehicles at once, studies, vehicle files and data sets.

This package holds the static libraries, the headers and the files by which
CMake finds them: find_package(wingbeat).")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libeigen3-dev, libceres-dev, libxsimd-dev, libsundials-dev, libboost-dev, libnlopt-dev, libnlopt-cxx-dev,\
 libfmt-dev, libtomlplusplus-dev, nlohmann-json3-dev, libtbb-dev, libnetcdf-dev, libhdf5-dev, libmatio-dev, libzip-dev,\
 libudunits2-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS wingbeat-doc)

if(TARGET wingbeat_python)
  find_package(Python 3.11 REQUIRED COMPONENTS Interpreter)
  wingbeat_package(python3 python3-wingbeat python
"model of flapping-wing micro air vehicles for Python
Vehicles, their steady flapping with exact derivatives, start-up in time,
arrays of designs on all cores, sweeps as xarray data sets, fits, optima and
the equations of motion, with the numbers of the program wingbeat.

This package holds the module wingbeat for Debian's Python 3.")
  set(CPACK_DEBIAN_PYTHON3_PACKAGE_SHLIBDEPS ON)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON3_PACKAGE_DEPENDS
    "python3 (>= 3.${Python_VERSION_MINOR}~), python3 (<< 3.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON3_PACKAGE_RECOMMENDS "wingbeat, python3-xarray, python3-netcdf4")
  set(CPACK_DEBIAN_PYTHON3_PACKAGE_SUGGESTS "wingbeat-doc, python3-matplotlib, python3-tqdm")
  # Compiled files of Python come and go with the package.
  set(CPACK_DEBIAN_PYTHON3_PACKAGE_CONTROL_EXTRA
    "${PROJECT_SOURCE_DIR}/packaging/debian/postinst;${PROJECT_SOURCE_DIR}/packaging/debian/prerm")
  set(CPACK_DEBIAN_PYTHON3_PACKAGE_CONTROL_STRICT_PERMISSION ON)
endif()

# scripts/build-packages writes the site first.
wingbeat_package(documentation wingbeat-doc doc
"model of flapping-wing micro air vehicles, documentation
The manual of wingbeat: tutorials, commands, vehicle files, the model with its
equations and its validation, numerics, the library's interface, and the
figures of the 2022 friction paper reproduced.")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
install(DIRECTORY ${PROJECT_BINARY_DIR}/site/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/wingbeat-doc/html
  COMPONENT documentation PATTERN made-by-build-site EXCLUDE)
install(FILES packaging/debian/wingbeat-doc DESTINATION ${CMAKE_INSTALL_DATADIR}/doc-base COMPONENT documentation)

include(CPack)
