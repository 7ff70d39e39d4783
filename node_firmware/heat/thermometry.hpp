#pragma once
// From what a converter measures to degrees. A table of straight lines is made when the sensor is configured;
// reading it takes two look-ups and two multiplications of 32 bits, no division.
//
//   divider     reference - pull-up - (ratio) - sensor - ground: ratio = R / (R + pull-up)
//   MAX31865    ratio = R / reference resistor
//
// Temperatures are thousandths of a degree Celsius (mC), ratios are parts of 2^20.

#include <array>
#include <cstdint>
#include <optional>

namespace kinebus::heat {

inline constexpr std::uint32_t kFullRatio = 1u << 20;
/// What no sensor reaches: a set point or limit above it is a mistake.
inline constexpr std::int32_t kLowestTable = -50'000, kHighestTable = 600'000;

/// 6110h. Resistance thermometers have the numbers of CiA 404; thermistors are the manufacturer's.
enum class SensorKind : std::uint16_t {
  kNone = 0,
  kPt100 = 30,
  kPt1000 = 33,
  kEpcos100k = 10001,  ///< B57560G104F
  kSemitec104Gt2 = 10002,
  kSemitec104Nt4 = 10003,  ///< 104NT-4-R025H42G
  kGeneric3950 = 10004,
  kSlice450 = 10005,
  kNtc100kMgb18 = 10006,       ///< MGB18-104F39050L32
  kHoneywell100k = 10007,      ///< 135-104LAG-J01
  kTdkNtcg104 = 10008,         ///< NTCG104LH104JT1
  kCustomBeta = 10100,         ///< 2202h, 2203h
  kCustomThreePoints = 10101,  ///< 2204h to 2209h
};

enum class SensorPath : std::uint8_t { kDivider = 0, kMax31865 = 1 };

/// How an element hangs on a MAX31865.
struct RtdWiring {
  bool three_wires = false;  ///< else two or four
  bool mains_60hz = false;   ///< what its filter takes away; else 50 Hz
  friend constexpr bool operator==(const RtdWiring&, const RtdWiring&) = default;
};

struct ThermistorPoint {
  std::int32_t temperature_mc = 0;
  std::uint32_t resistance_mohm = 0;
  friend constexpr bool operator==(const ThermistorPoint&, const ThermistorPoint&) = default;
};

struct SensorSetup {
  SensorKind kind = SensorKind::kNone;
  SensorPath path = SensorPath::kDivider;
  std::uint32_t reference_mohm = 4'700'000;  ///< pull-up, or the MAX31865's reference resistor
  RtdWiring wiring{};                        ///< kMax31865
  std::uint32_t nominal_mohm = 100'000'000;  ///< kCustomBeta: at 25 C
  std::uint32_t beta_k = 3950;               ///< kCustomBeta
  std::array<ThermistorPoint, 3> points{};   ///< kCustomThreePoints
  std::int32_t low_mc = -20'000;             ///< below: not plausible
  std::int32_t high_mc = 350'000;            ///< above: not plausible
  friend constexpr bool operator==(const SensorSetup&, const SensorSetup&) = default;
};

enum class SetupError : std::uint8_t {
  kNone,
  kUnknownKind,
  kReference,     ///< no resistor, or one that this sensor cannot be measured with
  kNotMonotonic,  ///< resistance does not fall with temperature all the way, or two points are one
  kRange,         ///< low_mc, high_mc: not in order, or beyond what the table holds
};

/// One sensor's table.
class Linearisation {
 public:
  /// On an error the table measures nothing: kind() is kNone. Cost, without an FPU for doubles: some 200,000
  /// cycles.
  SetupError configure(const SensorSetup& setup);
  /// What configure() would say, for a tenth of it.
  static SetupError check(const SensorSetup& setup);
  SensorKind kind() const { return kind_; }
  /// mC; ends are clipped to the table's.
  std::int32_t milli_celsius(std::uint32_t ratio) const;
  /// Where the plausible range ends: ratios, lower one first.
  std::uint32_t low_ratio() const { return low_ratio_; }
  std::uint32_t high_ratio() const { return high_ratio_; }

 private:
  static constexpr int kLines = 144;
  struct Curve;
  SetupError prepare(const SensorSetup& setup, Curve& curve);
  void fill(const Curve& curve);
  std::int32_t coordinate(std::uint32_t ratio) const;

  SensorKind kind_ = SensorKind::kNone;
  bool logarithmic_ = true;
  std::int32_t start_ = 0;  // coordinate of the first point, 20 fractional bits
  int shift_ = 17;          // width of a line: 2^shift of them
  std::uint32_t low_ratio_ = 0, high_ratio_ = 0;
  std::array<std::int32_t, kLines + 1> points_{};
};

namespace platinum {
inline constexpr double kA = 3.9083e-3, kB = -5.775e-7, kC = -4.183e-12;
}
/// Resistance in Ohm of a resistance thermometer of 100 or 1000 Ohm (IEC 60751, Callendar-Van Dusen), -50 to
/// 850 C.
constexpr double callendar_van_dusen(double nominal_ohm, double celsius) {
  using namespace platinum;
  const double below = celsius < 0 ? kC * (celsius - 100) * celsius * celsius * celsius : 0;
  return nominal_ohm * (1 + kA * celsius + kB * celsius * celsius + below);
}

/// Its slope, Ohm/K.
constexpr double callendar_van_dusen_slope(double nominal_ohm, double celsius) {
  using namespace platinum;
  const double below = celsius < 0 ? kC * (4 * celsius - 300) * celsius * celsius : 0;
  return nominal_ohm * (kA + 2 * kB * celsius + below);
}

/// 1/T = a + b ln R + c (ln R)^3; T in K, R in Ohm. By beta, c is 0.
struct SteinhartHart {
  double a = 0, b = 0, c = 0;
  double kelvin(double log_ohm) const;
  /// ln R at a temperature, between those of 1 mOhm and 1 GOhm. Needs falls().
  double log_ohm(double at_kelvin) const;
  /// Resistance falls with temperature over the whole table.
  bool falls() const;
};
/// nullopt: no curve through these points.
std::optional<SteinhartHart> steinhart_hart(const std::array<ThermistorPoint, 3>& points);
SteinhartHart by_beta(double nominal_ohm, double beta_k);
/// Of one of the thermistors known by name, or of the custom ones; nullopt: none such, or no curve.
std::optional<SteinhartHart> thermistor_curve(const SensorSetup& setup);

}  // namespace kinebus::heat
