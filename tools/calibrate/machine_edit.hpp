#pragma once
// Something measured, in a machine file that somebody wrote by hand: everything else stays as it is, comments
// included.

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "gateway/description/machine_description.hpp"

namespace kinebus {

/// `text` with its [joint.*.calibration] and [calibration.*] tables replaced by those of `machine`.
/// Post-condition: parse_machine() of it gives `machine`. Error: why that cannot be, in words (`text` is left
/// alone then).
Result<std::string, std::string> with_calibration(const std::string& text, const MachineDescription& machine);

/// The same of the tables whose names `belongs` takes ("vibration.x"), under the comment `note`.
Result<std::string, std::string> with_tables(const std::string& text, const MachineDescription& machine,
                                             const std::function<bool(std::string_view table)>& belongs,
                                             std::string_view note);

/// Writes `text` in place of the file, after keeping the old one beside it: "m1.toml.before-1", -2, ...
/// Returns that name. Throws std::runtime_error when it cannot; the file is then unchanged.
std::filesystem::path replace_machine_file(const std::filesystem::path& file, const std::string& text);

}  // namespace kinebus
