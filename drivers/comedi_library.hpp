// drivers/comedi_library.hpp: the functions of libcomedi that we call, from the library that the
// robot's file names.
#pragma once

#include <string>

#include <comedilib.h>

namespace drivers {

struct ComediLibrary {
  decltype(&::comedi_open) open = nullptr;
  decltype(&::comedi_close) close = nullptr;
  decltype(&::comedi_errno) error = nullptr;
  decltype(&::comedi_strerror) error_text = nullptr;
  decltype(&::comedi_get_driver_name) driver_name = nullptr;
  decltype(&::comedi_get_board_name) board_name = nullptr;
  decltype(&::comedi_get_n_subdevices) subdevices = nullptr;
  decltype(&::comedi_get_subdevice_type) type = nullptr;
  decltype(&::comedi_get_n_channels) channels = nullptr;
  decltype(&::comedi_get_maxdata) maxdata = nullptr;
  decltype(&::comedi_get_n_ranges) ranges = nullptr;
  decltype(&::comedi_get_range) range = nullptr;
  decltype(&::comedi_from_phys) from_phys = nullptr;
  decltype(&::comedi_data_read) read = nullptr;
  decltype(&::comedi_data_write) write = nullptr;
  decltype(&::comedi_dio_config) configure_line = nullptr;
  decltype(&::comedi_dio_read) read_line = nullptr;
  decltype(&::comedi_dio_write) write_line = nullptr;
  decltype(&::comedi_reset) reset = nullptr;
  decltype(&::comedi_set_counter_mode) set_counter_mode = nullptr;
  decltype(&::comedi_arm) arm = nullptr;
};

/// The library stays loaded, since it may have started threads. Throws CardError.
ComediLibrary load_comedi(const std::string& name);

}  // namespace drivers
