# netCDF, HDF5, matio, libzip and UDUNITS-2 as imported targets, here and in projects that link wingbeat's archives:
# libraries and headers alone. Their own CMake packages name curl, crypto and whatever else they were built with, by
# absolute paths.
function(wingbeat_c_library name header)
  cmake_parse_arguments(OF "" "" "NAMES;FOLDERS" ${ARGN})
  if(TARGET wingbeat::${name})
    return()
  endif()
  find_path(WINGBEAT_${name}_INCLUDE ${header} PATH_SUFFIXES ${OF_FOLDERS})
  find_library(WINGBEAT_${name}_LIBRARY NAMES ${OF_NAMES} PATH_SUFFIXES ${OF_FOLDERS})
  mark_as_advanced(WINGBEAT_${name}_INCLUDE WINGBEAT_${name}_LIBRARY)
  if(NOT WINGBEAT_${name}_INCLUDE OR NOT WINGBEAT_${name}_LIBRARY)
    message(FATAL_ERROR "wingbeat needs ${name}: ${header} or its library was not found")
  endif()
  add_library(wingbeat::${name} UNKNOWN IMPORTED)
  set_target_properties(wingbeat::${name} PROPERTIES IMPORTED_LOCATION ${WINGBEAT_${name}_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${WINGBEAT_${name}_INCLUDE})
endfunction()
wingbeat_c_library(netcdf netcdf.h NAMES netcdf)
wingbeat_c_library(hdf5 hdf5.h NAMES hdf5_serial hdf5 FOLDERS hdf5/serial)
wingbeat_c_library(matio matio.h NAMES matio)
wingbeat_c_library(zip zip.h NAMES zip)
wingbeat_c_library(udunits udunits2.h NAMES udunits2 FOLDERS udunits2)
