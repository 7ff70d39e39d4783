#pragma once
// The pattern printed by the simulated machine, and its lines' widths as somebody would measure them.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "tools/simulation/nozzle.hpp"
#include "tools/tune/pressure_pattern.hpp"
#include "tools/tune/pressure_widths.hpp"

namespace kinebus {

/// Mean widths of the pattern's lines, from where the tool is and what comes out.
class PatternMeter {
 public:
  explicit PatternMeter(const PressurePattern& pattern);
  /// The tool has come to `pose`; `laid` mm of filament came out on the way.
  void add(const Pose& pose, double laid);
  std::vector<LineWidths> widths() const;

 private:
  /// Filament and way within a stretch of a line.
  struct Stretch {
    double from_mm = 0, over_mm = 0, laid_mm = 0, length_mm = 0;
  };
  double width(const Stretch& stretch) const;
  PressurePattern pattern_;
  std::vector<std::array<Stretch, 4>> lines_;  ///< faster, slower, and both near
  Pose last_{};
  bool placed_ = false;
};

/// Whoever measures is off by 0.01 mm rms, and reads hundredths. Error: the job came to no good end.
Result<std::vector<LineWidths>, std::string> print_simulated(const MachineDescription& machine,
                                                             const PressurePattern& pattern,
                                                             const Nozzle::Truth& truth, std::uint64_t seed);

}  // namespace kinebus
