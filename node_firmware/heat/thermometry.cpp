#include "node_firmware/heat/thermometry.hpp"

#include <algorithm>
#include <bit>

#include "node_firmware/heat/elementary.hpp"

namespace kinebus::heat {
namespace {

constexpr double kZeroCelsius = 273.15;
constexpr double kLn2 = 0.69314718055994530942;
constexpr double kCoordinateOne = 1 << 20;

// log2(1 + i/128), 20 fractional bits. Straight lines between: 1.1e-5 octaves, 0.6 mK of a thermistor.
constexpr int kLogLines = 128;
constexpr auto kLog2 = [] {
  std::array<std::uint32_t, kLogLines + 1> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = nearest_whole(natural_log(1 + static_cast<double>(i) / kLogLines) / kLn2 * kCoordinateOne);
  return table;
}();

// value > 0; 20 fractional bits.
std::int32_t log2_of(std::uint32_t value) {
  const int exponent = static_cast<int>(std::bit_width(value)) - 1;
  const std::uint32_t mantissa = value << (31 - exponent);
  const std::size_t line = (mantissa >> 24) & static_cast<std::uint32_t>(kLogLines - 1);
  const std::uint32_t part = (mantissa >> 8) & 0xFFFF;
  const std::uint32_t log = kLog2[line] + (((kLog2[line + 1] - kLog2[line]) * part) >> 16);
  return static_cast<std::int32_t>(log) + (exponent << 20);
}

struct Named {
  SensorKind kind;
  std::array<ThermistorPoint, 3> points;  // by beta: only the first, and `beta_k`
  std::uint32_t beta_k = 0;
};
// Points as the makers' sheets and the configurations of printers' firmware give them.
constexpr std::array kNamed{
    Named{SensorKind::kEpcos100k, {{{25'000, 100'000'000}, {150'000, 1'641'900}, {250'000, 226'150}}}},
    Named{SensorKind::kSemitec104Gt2, {{{20'000, 126'800'000}, {150'000, 1'360'000}, {300'000, 80'650}}}},
    Named{SensorKind::kSemitec104Nt4, {{{25'000, 100'000'000}, {160'000, 1'074'000}, {300'000, 82'780}}}},
    Named{SensorKind::kGeneric3950, {{{25'000, 100'000'000}, {150'000, 1'770'000}, {250'000, 230'000}}}},
    Named{SensorKind::kSlice450, {{{25'000, 500'000'000}, {200'000, 3'734'000}, {400'000, 240'000}}}},
    Named{SensorKind::kNtc100kMgb18, {{{25'000, 100'000'000}}}, 4100},
    Named{SensorKind::kHoneywell100k, {{{25'000, 100'000'000}}}, 3974},
    Named{SensorKind::kTdkNtcg104, {{{25'000, 100'000'000}, {50'000, 31'230'000}, {125'000, 2'066'000}}}},
};

double celsius(std::int32_t milli) {
  return milli / 1000.0;
}
double ohm(std::uint32_t milli) {
  return milli / 1000.0;
}

constexpr double kHottest = 1200;  // what no table goes beyond

// One of Newton's steps to the celsius of a resistance thermometer, on a curve that is nearly straight.
double rtd_step(double nominal_ohm, double resistance, double near) {
  return near -
         (callendar_van_dusen(nominal_ohm, near) - resistance) / callendar_van_dusen_slope(nominal_ohm, near);
}

std::int32_t milli(double degrees) {
  const double clipped = std::clamp(degrees, -273.0, kHottest) * 1000;
  return static_cast<std::int32_t>(clipped < 0 ? clipped - 0.5 : clipped + 0.5);
}

}  // namespace

double SteinhartHart::kelvin(double log_ohm_value) const {
  const double inverse = a + log_ohm_value * (b + c * log_ohm_value * log_ohm_value);
  return inverse < 1.0 / 1500 ? 1500 : 1 / inverse;
}

double SteinhartHart::log_ohm(double at_kelvin) const {
  double low = -6.9, high = 20.7;
  for (int i = 0; i < 44; ++i) {
    const double middle = (low + high) / 2;
    (kelvin(middle) > at_kelvin ? low : high) = middle;
  }
  return (low + high) / 2;
}

bool SteinhartHart::falls() const {
  // The slope b + 3 c L^2 is positive at both ends of 1 Ohm to 100 MOhm, and so between them.
  return b > 0 && b + 3 * c * 18.4 * 18.4 > 0;
}

std::optional<SteinhartHart> steinhart_hart(const std::array<ThermistorPoint, 3>& points) {
  std::array<double, 3> l{}, y{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double kelvin = celsius(points[i].temperature_mc) + kZeroCelsius;
    if (points[i].resistance_mohm == 0 || kelvin < 100) return std::nullopt;
    l[i] = natural_log(ohm(points[i].resistance_mohm));
    y[i] = 1 / kelvin;
  }
  // The hotter the less: otherwise it is no thermistor, or two points are one.
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < i; ++k)
      if ((l[i] - l[k]) * (y[i] - y[k]) < 1e-9) return std::nullopt;
  const double g2 = (y[1] - y[0]) / (l[1] - l[0]), g3 = (y[2] - y[0]) / (l[2] - l[0]);
  SteinhartHart curve;
  curve.c = (g3 - g2) / (l[2] - l[1]) / (l[0] + l[1] + l[2]);
  curve.b = g2 - curve.c * (l[0] * l[0] + l[0] * l[1] + l[1] * l[1]);
  curve.a = y[0] - (curve.b + curve.c * l[0] * l[0]) * l[0];
  if (!curve.falls()) return std::nullopt;
  return curve;
}

SteinhartHart by_beta(double nominal_ohm, double beta_k) {
  const double b = 1 / beta_k;
  return {1 / (25 + kZeroCelsius) - b * natural_log(nominal_ohm), b, 0};
}

std::optional<SteinhartHart> thermistor_curve(const SensorSetup& setup) {
  if (setup.kind == SensorKind::kCustomBeta) {
    if (setup.nominal_mohm == 0 || setup.beta_k < 1000 || setup.beta_k > 10'000) return std::nullopt;
    return by_beta(ohm(setup.nominal_mohm), setup.beta_k);
  }
  if (setup.kind == SensorKind::kCustomThreePoints) return steinhart_hart(setup.points);
  const auto known =
      std::find_if(kNamed.begin(), kNamed.end(), [&](const Named& each) { return each.kind == setup.kind; });
  if (known == kNamed.end()) return std::nullopt;
  return known->beta_k != 0 ? by_beta(ohm(known->points[0].resistance_mohm), known->beta_k)
                            : steinhart_hart(known->points);
}

struct Linearisation::Curve {
  bool rtd = false;
  double reference = 0, nominal = 0;  ///< Ohm
  SteinhartHart thermistor{};
};

SetupError Linearisation::check(const SensorSetup& setup) {
  Linearisation trial;
  Curve curve;
  return trial.prepare(setup, curve);
}

SetupError Linearisation::configure(const SensorSetup& setup) {
  kind_ = SensorKind::kNone;
  Curve curve;
  const SetupError error = prepare(setup, curve);
  if (error != SetupError::kNone) return error;
  fill(curve);
  kind_ = setup.kind;
  return SetupError::kNone;
}

// All but the points.
SetupError Linearisation::prepare(const SensorSetup& setup, Curve& curve) {
  const bool rtd = setup.kind == SensorKind::kPt100 || setup.kind == SensorKind::kPt1000;
  const bool named =
      std::any_of(kNamed.begin(), kNamed.end(), [&](const Named& each) { return each.kind == setup.kind; });
  const bool custom = setup.kind == SensorKind::kCustomBeta || setup.kind == SensorKind::kCustomThreePoints;
  if (!rtd && !named && !custom) return SetupError::kUnknownKind;
  if (setup.reference_mohm < 10'000 || (setup.path == SensorPath::kMax31865 && !rtd))
    return SetupError::kReference;
  if (setup.low_mc >= setup.high_mc || setup.low_mc < kLowestTable || setup.high_mc > kHighestTable)
    return SetupError::kRange;
  const double reference = ohm(setup.reference_mohm);
  const double nominal = setup.kind == SensorKind::kPt100 ? 100 : 1000;
  curve = {.rtd = rtd, .reference = reference, .nominal = nominal};
  if (!rtd) {
    const auto thermistor = thermistor_curve(setup);
    if (!thermistor) return SetupError::kNotMonotonic;
    curve.thermistor = *thermistor;
  }
  logarithmic_ = setup.path == SensorPath::kDivider;
  if (!logarithmic_) {
    // 1/128 of the reference resistor a line: 3 mK at 430 Ohm.
    start_ = 0;
    shift_ = 13;
  } else if (rtd) {
    // -50 to 600 C are 1.97 octaves; 1/64 octave a line: 8 mK.
    const double first = natural_log(callendar_van_dusen(nominal, -50.5) / reference) / kLn2;
    start_ = static_cast<std::int32_t>(first * kCoordinateOne);
    shift_ = 14;
  } else {
    // From 1/256 to 1024 times the pull-up; 1/8 octave a line: 25 mK at 300 C.
    start_ = -8 * (1 << 20);
    shift_ = 17;
  }
  const auto ratio_at = [&](std::int32_t mc) {
    const double resistance = rtd ? callendar_van_dusen(nominal, celsius(mc))
                                  : exponential(curve.thermistor.log_ohm(celsius(mc) + kZeroCelsius));
    const double share = logarithmic_ ? resistance / (resistance + reference) : resistance / reference;
    return nearest_whole(std::clamp(share, 0.0, 1.0) * kFullRatio);
  };
  low_ratio_ = ratio_at(rtd ? setup.low_mc : setup.high_mc);
  high_ratio_ = ratio_at(rtd ? setup.high_mc : setup.low_mc);
  // A range that the converter cannot tell from open or shorted would leave those unseen.
  constexpr std::uint32_t kSeen = kFullRatio / 2048;
  if (low_ratio_ < kSeen || high_ratio_ > kFullRatio - kSeen || low_ratio_ >= high_ratio_)
    return SetupError::kReference;
  if (coordinate(low_ratio_) < start_ || coordinate(high_ratio_) >= start_ + (kLines << shift_))
    return SetupError::kReference;
  return SetupError::kNone;
}

// Of each point only what needs a division or two: the logarithm of a thermistor's resistance goes evenly
// along the table, and a resistance thermometer's points lead from one to the next.
void Linearisation::fill(const Curve& curve) {
  const double width = (1 << shift_) / kCoordinateOne, from = start_ / kCoordinateOne;
  const double log_reference = natural_log(curve.reference), growth = exponential(width * kLn2);
  double resistance = logarithmic_ ? curve.reference * exponential(from * kLn2) : 0;
  double near = (resistance / curve.nominal - 1) / 3.85e-3, before = near;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double u = from + static_cast<double>(i) * width;
    if (curve.rtd) {
      if (!logarithmic_) resistance = curve.reference * u;
      // As far on as the last one: 0.1 K beside it at most, and 1 uK after one step.
      const double guess = near + (near - before);
      before = near;
      near = guess < kHottest ? rtd_step(curve.nominal, resistance, guess) : kHottest;
      for (int first = 0; i == 0 && first < 6; ++first)
        before = near = rtd_step(curve.nominal, resistance, near);
      if (logarithmic_) resistance *= growth;
      points_[i] = milli(near);
    } else {
      points_[i] = milli(curve.thermistor.kelvin(log_reference + u * kLn2) - kZeroCelsius);
    }
  }
}

std::int32_t Linearisation::coordinate(std::uint32_t ratio) const {
  if (!logarithmic_) return static_cast<std::int32_t>(ratio);
  const std::uint32_t inside = std::clamp<std::uint32_t>(ratio, 1, kFullRatio - 1);
  return log2_of(inside) - log2_of(kFullRatio - inside);
}

std::int32_t Linearisation::milli_celsius(std::uint32_t ratio) const {
  const std::int32_t last = (kLines << shift_) - 1;
  const auto along = static_cast<std::uint32_t>(
      std::clamp(coordinate(std::min(ratio, kFullRatio)) - start_, std::int32_t{0}, last));
  const std::size_t line = along >> shift_;
  // 12 bits along the line keep the product of a slope within 32 bits.
  const auto part = static_cast<std::int32_t>((along & ((1u << shift_) - 1)) >> (shift_ - 12));
  return points_[line] + (((points_[line + 1] - points_[line]) * part) >> 12);
}

}  // namespace kinebus::heat
