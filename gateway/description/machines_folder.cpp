#include "gateway/description/machines_folder.hpp"

namespace kinebus {

std::filesystem::path machines_folder() {
  return KINEBUS_MACHINES;
}

}  // namespace kinebus
