// drivers/comedi_library.cpp: loading libcomedi.
#include "drivers/comedi_library.hpp"

#include <dlfcn.h>

#include "drivers/analog_card.hpp"

namespace drivers {
namespace {

std::string last_error() {
  const char* const text = ::dlerror();  // NOLINT(concurrency-mt-unsafe): glibc's is per thread
  return text != nullptr ? text : "unknown error";
}

}  // namespace

ComediLibrary load_comedi(const std::string& name) {
  void* const handle = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) {
    throw CardError("The library of the analog card cannot be loaded (" + last_error() +
                    "). Debian's package is libcomedi0.");
  }
  const auto find = [&](auto& function, const char* symbol) {
    function =
        reinterpret_cast<std::remove_reference_t<decltype(function)>>(  // NOLINT: dlsym's way
            ::dlsym(handle, symbol));
    if (function == nullptr) throw CardError(name + " has no " + symbol + ": it is no libcomedi.");
  };
  ComediLibrary out;
  find(out.open, "comedi_open");
  find(out.close, "comedi_close");
  find(out.error, "comedi_errno");
  find(out.error_text, "comedi_strerror");
  find(out.driver_name, "comedi_get_driver_name");
  find(out.board_name, "comedi_get_board_name");
  find(out.subdevices, "comedi_get_n_subdevices");
  find(out.type, "comedi_get_subdevice_type");
  find(out.channels, "comedi_get_n_channels");
  find(out.maxdata, "comedi_get_maxdata");
  find(out.ranges, "comedi_get_n_ranges");
  find(out.range, "comedi_get_range");
  find(out.from_phys, "comedi_from_phys");
  find(out.read, "comedi_data_read");
  find(out.write, "comedi_data_write");
  find(out.configure_line, "comedi_dio_config");
  find(out.read_line, "comedi_dio_read");
  find(out.write_line, "comedi_dio_write");
  find(out.reset, "comedi_reset");
  find(out.set_counter_mode, "comedi_set_counter_mode");
  find(out.arm, "comedi_arm");
  return out;
}

}  // namespace drivers
