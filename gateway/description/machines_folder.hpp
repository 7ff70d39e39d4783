#pragma once

#include <filesystem>

namespace kinebus {

/// Where this clone keeps its machine files: for tests and pictures, which read them as they read a user's.
std::filesystem::path machines_folder();

}  // namespace kinebus
