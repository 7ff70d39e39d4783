#pragma once
// Macros in files beside the machine file.

#include <filesystem>

#include "gateway/description/machine_file.hpp"

namespace kinebus {

/// Adds each file of `folder` that ends in .g, .gcode, .nc or .ngc as the macro of its name (wipe.g: `wipe`);
/// without such a folder nothing. What is wrong is told in `errors`: a name of other than 1 to 32 letters,
/// digits, -, . and _, one that is a macro already, O words without end, more than 256 files or 1 MiB.
void add_macro_files(const std::filesystem::path& folder, std::vector<MacroDescription>& macros,
                     MachineFileErrors& errors);

}  // namespace kinebus
