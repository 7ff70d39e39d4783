#pragma once
// What a machine has besides motion, and where each of it lives. Units in the names; temperatures in deg C.

#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>

namespace kinebus {

/// Where a device lives. Named in the machine file by `where`.
struct DevicePlace {
  enum class Where : std::uint8_t { kSimulated, kNode };
  Where where = Where::kSimulated;
  std::uint8_t node_id = 0;  ///< 1..126; of kNode
  std::uint8_t channel = 0;  ///< 1 ..: among the node's channels of this kind; of kNode
  bool on_node() const { return where == Where::kNode; }
  friend bool operator==(const DevicePlace&, const DevicePlace&) = default;
};

enum class HeaterKind : std::uint8_t { kHotend, kBed, kChamber };
inline constexpr std::size_t kHeaterKinds = 3;
inline constexpr std::uint8_t kMostOfAKind = 8;  ///< heaters of a kind; fans; outputs

/// Which heater: hot ends count as tools do (T0, T1, ...), beds and chambers among themselves.
struct HeaterId {
  HeaterKind kind = HeaterKind::kHotend;
  std::uint8_t index = 0;
  friend bool operator==(const HeaterId&, const HeaterId&) = default;
  friend bool operator<(const HeaterId& a, const HeaterId& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.index < b.index;
  }
};
inline constexpr HeaterId kFirstHotend{HeaterKind::kHotend, 0}, kFirstBed{HeaterKind::kBed, 0};

/// Its limits, and the heat model that the simulated one uses.
struct HeaterDescription {
  std::string name;  ///< of its table
  HeaterKind kind = HeaterKind::kHotend;
  std::uint8_t index = 0;
  DevicePlace place{};
  double max_c = 300;
  double window_c = 2;             ///< reached: within the window ...
  std::chrono::seconds settle{3};  ///< ... for so long
  double sim_power_w = 40;
  double sim_heat_capacity_j_per_k = 10;
  double sim_loss_w_per_k = 0.12;
  HeaterId id() const { return {kind, index}; }
  friend bool operator==(const HeaterDescription&, const HeaterDescription&) = default;
};

/// A fan of a print: M106 P.
struct FanDescription {
  std::string name;
  std::uint8_t index = 0;
  DevicePlace place{};
  friend bool operator==(const FanDescription&, const FanDescription&) = default;
};

/// Something that is switched or dimmed: M42 P.
struct OutputDescription {
  std::string name;
  std::uint8_t index = 0;
  DevicePlace place{};
  friend bool operator==(const OutputDescription&, const OutputDescription&) = default;
};

/// A temperature that is measured and not controlled.
struct SensorDescription {
  std::string name;
  DevicePlace place{};
  double sim_c = 23;
  friend bool operator==(const SensorDescription&, const SensorDescription&) = default;
};

/// What a mill cuts with.
struct SpindleDescription {
  bool present = false;
  DevicePlace place{};
  double min_rpm = 1000, max_rpm = 24000;
  bool reversible = false;  ///< M4
  double sim_rpm_per_s = 6000;
  friend bool operator==(const SpindleDescription&, const SpindleDescription&) = default;
};

/// What tells that the tool touches. On a node `channel` is the switch input that has the probe function.
struct ProbeDescription {
  bool present = false;
  DevicePlace place{};
  friend bool operator==(const ProbeDescription&, const ProbeDescription&) = default;
};

/// What holds for all heat of the machine.
struct ThermalDescription {
  double ambient_c = 23;
  double min_extrude_c = 170;  ///< E does not move forward below it
  friend bool operator==(const ThermalDescription&, const ThermalDescription&) = default;
};

/// The functions that a node carries. Nothing is asked of a node that it does not have.
struct NodeFunctions {
  std::uint8_t axis_pairs = 1;  ///< CiA 402 axes A and B with their stream: 0 or 1
  std::uint8_t inputs = 7;      ///< switch inputs
  std::uint8_t heaters = 0;     ///< channels, each with its sensor
  std::uint8_t sensors = 0;     ///< channels that only measure
  std::uint8_t outputs = 0;     ///< channels for fans, outputs and a spindle
  bool has_axes() const { return axis_pairs > 0; }
  friend bool operator==(const NodeFunctions&, const NodeFunctions&) = default;
};

}  // namespace kinebus
