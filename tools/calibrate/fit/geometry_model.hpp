#pragma once
// What a four-leg machine (M1, M5) with unknown deviations would measure.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus {

/// Deviations of one machine from its description: true less described.
struct MachineDeviation {
  M1Correction geometry;
  std::array<double, 4> offset_mm{};  ///< of the home switches along their rails
  std::array<double, 4> scale{};      ///< of the rails, about the switch positions
};

/// The machine as its controller believes it, and where its switches are believed to be.
struct BelievedMachine {
  M1Geometry geometry;
  std::array<double, 4> switch_mm{40, 40, 40, 40};
};

/// One reading. `commanded`: the pose that the controller was told, table coordinates, C = 0.
struct GeometryReading {
  enum class Kind : std::uint8_t {
    kPoint,  ///< where the tool is over the table: X, Y, Z, those that `has` says (touch probe, tracker)
    kGauge,  ///< a dial gauge on the table along `direction`, its zero anywhere but the same within a series
    kBallBar,  ///< distance from a ball on the table whose place is not known, the same within a series
  };
  Kind kind = Kind::kPoint;
  Pose commanded{};
  Vector3 value_mm{};  ///< kGauge, kBallBar: value_mm[0]
  std::array<bool, 3> has{true, true, true};
  Vector3 direction{0, 0, 1};
  int series = 0;
  double sigma_mm = 0.01;
};

/// Unknowns by name, in the order of a parameter vector: for each leg foot (3), rail lean (2), attachment
/// (3), length, switch offset, scale; the table's tilt about X and Y as gauges on it see it; then for each
/// series of gauges a zero, of ball bars the ball's place (3).
class GeometryModel {
 public:
  GeometryModel(const BelievedMachine& machine, std::vector<GeometryReading> readings);

  struct Parameter {
    std::string name;     ///< "leg2 attachment y"
    double prior = 1;     ///< how large it may reasonably be, mm or rad
    bool machine = true;  ///< of the machine; else of the way it was measured
    std::string unit = "mm";
  };
  const std::vector<Parameter>& parameters() const { return parameters_; }
  const std::vector<GeometryReading>& readings() const { return readings_; }
  std::size_t residual_count() const { return residual_count_; }
  std::vector<double> start()
      const;  ///< all deviations 0; zeros and balls as a first look at the readings says

  /// Measured less predicted, over sigma. nullopt: a pose cannot be reached with these deviations.
  std::optional<std::vector<double>> residuals(const std::vector<double>& x) const;
  /// d residuals / d x by central differences, row-major residual_count x parameters.
  std::optional<std::vector<double>> jacobian(const std::vector<double>& x) const;

  /// Where the tool of a machine with these deviations is, commanded to go to a pose. Table coordinates, A
  /// last.
  std::optional<std::array<double, 4>> tool(const MachineDeviation& deviation, const Pose& commanded) const;
  static MachineDeviation deviation(const std::vector<double>& x);

 private:
  struct Commanded {
    JointVector joints{};
    bool reached = false;
  };
  std::optional<std::array<double, 4>> tool_at(const struct DeviatedMachine& machine,
                                               const JointVector& joints, const Pose& near) const;

  BelievedMachine machine_;
  std::unique_ptr<Kinematics> believed_;
  std::vector<GeometryReading> readings_;
  std::vector<Commanded> commanded_;
  std::vector<Parameter> parameters_;
  std::vector<std::size_t> series_at_;  ///< first parameter of each reading's series
  std::size_t residual_count_ = 0;
};

}  // namespace kinebus
