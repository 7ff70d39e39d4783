#pragma once
// What the same word means to different firmware and controllers. One table: the interpreter (and with it
// plan, run, the desktop's preview and the composer) and the reference read it.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kinebus::gcode {

enum class Dialect : std::uint8_t {
  kGeneral,  ///< not stated and not recognised: printers and RS274/NGC as far as they agree
  kMarlin,
  kRepRapFirmware,
  kKlipper,
  kRepetier,
  kSmoothie,
  kMach3,
  kMachinekit,
  kLinuxCnc,
};

/// A row of the table. kGeneral has no say where it is marked so: there the machine decides.
struct DialectRules {
  Dialect dialect = Dialect::kGeneral;
  std::string_view key;           ///< in the machine file
  std::string_view name;          ///< as its makers write it
  bool dwell_p_seconds = false;   ///< G4 P; kGeneral: on machines with a spindle
  bool traverse_has_feed = true;  ///< an F that stood with G0 limits G0; kGeneral: without a spindle
  bool a_extrudes = false;        ///< A is E, on machines without a spindle
  bool p_is_value = false;        ///< M104 P200, M106 P127: P stands for S; G22 and G23 retract and recover
  bool share_of_one = false;      ///< M106 S and M42 S up to 1 are a share, above it of 255
  enum class Extruder : std::uint8_t {
    kG91Takes,   ///< G91 takes E along, G90 goes back to what M82 or M83 said
    kG90Sets,    ///< G90 and G91 set E as well
    kM82M83Only  ///< G90 and G91 leave E alone
  } extruder = Extruder::kG91Takes;
  enum class G10 : std::uint8_t {
    kByWords,   ///< L: offsets; P or S: temperature of a tool; else retraction
    kRetracts,  ///< L: offsets; else retraction (S: the longer one of a swap)
    kOffsets    ///< L alone
  } g10 = G10::kByWords;
  bool m0_ends = false;           ///< M0 and M1 end the job
  bool m203_per_minute = false;   ///< M203 in mm/min
  bool m201_is_printing = false;  ///< M201 X Y: acceleration of printing moves, not limits of axes
};

std::span<const DialectRules> dialects();
const DialectRules& rules_of(Dialect dialect);

/// What a comment of the text's beginning says of who reads the text.
struct Header {
  std::optional<Dialect> dialect;
  bool a_extrudes = false;      ///< its writer puts A for E where the firmware wants it, and turns no axes
  std::string_view volumetric;  ///< not empty: E is in mm^3 to this flavour
};
Header read_dialect(std::string_view comment);

/// Where dialects differ about a code ("g4", "m106"; lower case), a line each; empty: they agree.
std::string dialect_differences(std::string_view code);
/// All that a dialect ("marlin") says, a line each; empty: there is none of this name.
std::string dialect_entry(std::string_view key);

}  // namespace kinebus::gcode
