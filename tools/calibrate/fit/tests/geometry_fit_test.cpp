#include "tools/calibrate/fit/geometry_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kinebus {
namespace {

struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  double normal(double sigma) { return std::normal_distribution<double>(0, sigma)(engine); }
  Pose pose() {
    const double r = 100 * std::sqrt(uniform(0, 1)), f = uniform(-3.2, 3.2);
    return {r * std::cos(f), r * std::sin(f), uniform(5, 200), uniform(-35, 35) * kRadPerDeg, 0, 0};
  }
  std::mt19937_64 engine;
};

/// Half a millimetre of everything, three tenths at the switches.
MachineDeviation hidden(Random& random) {
  MachineDeviation d;
  for (std::size_t i = 0; i < 4; ++i) {
    M1LegCorrection& leg = d.geometry.legs[i];
    for (std::size_t k = 0; k < 3; ++k) {
      leg.foot_mm[k] = random.uniform(-0.5, 0.5);
      leg.attachment_mm[k] = random.uniform(-0.5, 0.5);
    }
    leg.rail = {random.uniform(-5e-4, 5e-4), random.uniform(-5e-4, 5e-4), 0};
    leg.length_mm = random.uniform(-0.5, 0.5);
    d.offset_mm[i] = random.uniform(-0.3, 0.3);
  }
  return d;
}

double error_rms(const GeometryModel& truth_model, const MachineDeviation& truth,
                 const MachineDeviation& believed, Random& random) {
  // The controller believes `believed`: it commands carriages so that its own model stands at the pose. Both
  // models' tools for the same carriages are compared, over the workspace.
  double sum = 0;
  int count = 0;
  for (int n = 0; n < 400; ++n) {
    const Pose pose = random.pose();
    const auto a = truth_model.tool(truth, pose), b = truth_model.tool(believed, pose);
    if (!a || !b) continue;
    for (std::size_t k = 0; k < 3; ++k) sum += std::pow((*a)[k] - (*b)[k], 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

std::vector<GeometryReading> measure(const MachineDeviation& truth, const std::vector<Pose>& poses,
                                     double noise, Random& random) {
  const GeometryModel model({}, {});
  std::vector<GeometryReading> out;
  for (const Pose& pose : poses) {
    const auto t = model.tool(truth, pose);
    if (!t) continue;
    GeometryReading r;
    r.commanded = pose;
    for (std::size_t k = 0; k < 3; ++k) r.value_mm[k] = (*t)[k] + random.normal(noise);
    out.push_back(r);
  }
  return out;
}

TEST(GeometryFit, HiddenErrorsOfHalfAMillimetreComeDownTo25Micrometres) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Random random(seed);
    const MachineDeviation truth = hidden(random);
    std::vector<Pose> poses;
    for (int n = 0; n < 100; ++n) poses.push_back(random.pose());
    const GeometryModel model({}, measure(truth, poses, 0.01, random));
    const GeometryFit fit = fit_geometry(model, {});
    ASSERT_TRUE(fit.solved) << fit.problem;
    EXPECT_GT(fit.before_rms_mm, 0.2);
    EXPECT_LT(fit.after_rms_mm, 0.0115);
    EXPECT_GT(error_rms(model, truth, {}, random), 0.3);
    EXPECT_LT(error_rms(model, truth, fit.deviation, random), 0.025) << "seed " << seed;
  }
}

TEST(GeometryFit, WhatCannotBeToldIsSaidAndHeld) {
  Random random(5);
  const MachineDeviation truth = hidden(random);
  std::vector<Pose> poses;
  for (int n = 0; n < 60; ++n) poses.push_back(random.pose());
  const GeometryFit fit = fit_geometry(GeometryModel({}, measure(truth, poses, 0.01, random)), {});
  ASSERT_TRUE(fit.solved);
  // A foot's height and its switch's offset both move the carriage along the rail: only one of the two is
  // free.
  for (int leg = 1; leg <= 4; ++leg) {
    const std::string name = "leg" + std::to_string(leg) + " ";
    int held = 0;
    for (const FittedParameter& p : fit.parameters)
      if (p.name == name + "foot z" || p.name == name + "switch offset") {
        held += p.held ? 1 : 0;
        if (p.held) {
          EXPECT_EQ(p.value, 0);
          EXPECT_NE(p.why.find("cannot be told from"), std::string::npos);
        }
      }
    EXPECT_GE(held, 1) << name;
  }
}

TEST(GeometryFit, StraightnessReadingsGiveTheSwitchOffsetsInOneFit) {
  // Paper M5: a gauge on the table reads the height along X and along Y; one more at a tilt, and the table
  // leans.
  Random random(6);
  MachineDeviation truth;
  truth.offset_mm = {0.3, -0.2, 0.15, -0.25};
  const GeometryModel model({}, {});
  const double tilt_x = 0.4e-3, tilt_y = -0.7e-3;
  std::vector<GeometryReading> readings;
  int series = 0;
  const auto traverse = [&](const Vector3& along, double a_rad, const Vector3& direction) {
    ++series;
    for (int k = -10; k <= 10; ++k) {
      GeometryReading r;
      r.kind = GeometryReading::Kind::kGauge;
      r.commanded = {along[0] * 9 * k, along[1] * 9 * k, 50, a_rad, 0, 0};
      r.direction = direction;
      r.series = series;
      r.sigma_mm = 0.002;
      const auto t = *model.tool(truth, r.commanded);
      const double z = t[2] + tilt_x * t[1] - tilt_y * t[0];
      r.value_mm[0] =
          direction[0] * t[0] + direction[1] * t[1] + direction[2] * z + 3.21 * series + random.normal(0.001);
      readings.push_back(r);
    }
  };
  for (const double a : {0.0, 0.4, -0.4}) {
    traverse({1, 0, 0}, a, {0, 0, 1});
    traverse({0, 1, 0}, a, {0, 0, 1});
    traverse({1, 0, 0}, a, {0, 1, 0});
    traverse({0, 1, 0}, a, {1, 0, 0});
  }
  const GeometryFit fit = fit_geometry(GeometryModel({}, readings), {.switch_offsets_only = true});
  ASSERT_TRUE(fit.solved) << fit.problem;
  EXPECT_GT(fit.before_rms_mm, 0.01);
  EXPECT_LT(fit.after_rms_mm, 0.0015);
  // A gauge's zero hides what is common to all heights: one offset is held, the straightness comes out all
  // the same.
  int held = 0;
  for (const FittedParameter& p : fit.parameters) held += p.held && p.name.ends_with("switch offset") ? 1 : 0;
  EXPECT_GE(held, 1);
  for (const FittedParameter& p : fit.parameters) {
    if (p.name == "table tilt about x") {
      EXPECT_NEAR(p.value, tilt_x, 0.05e-3);
    }
    if (p.name == "table tilt about y") {
      EXPECT_NEAR(p.value, tilt_y, 0.05e-3);
    }
  }
}

TEST(GeometryFit, BallBarReadingsDetermineLengths) {
  Random random(8);
  MachineDeviation truth;
  for (std::size_t i = 0; i < 4; ++i) truth.offset_mm[i] = random.uniform(-0.3, 0.3);
  const GeometryModel model({}, {});
  std::vector<GeometryReading> readings;
  const Vector3 balls[] = {{20, -10, 0}, {-30, 15, 0}};
  for (int series = 0; series < 2; ++series)
    for (int k = 0; k < 40; ++k) {
      GeometryReading r;
      r.kind = GeometryReading::Kind::kBallBar;
      const double f = 0.157 * k, up = 0.3 + 0.02 * k;
      const Vector3& b = balls[series];
      r.commanded = {b[0] + 80 * std::cos(f) * std::cos(up),
                     b[1] + 80 * std::sin(f) * std::cos(up),
                     b[2] + 10 + 80 * std::sin(up),
                     0.3 * std::sin(0.5 * k),
                     0,
                     0};
      const auto t = *model.tool(truth, r.commanded);
      r.value_mm[0] = std::hypot(t[0] - b[0], t[1] - b[1], t[2] - b[2] - 10) + random.normal(0.002);
      r.series = series;
      r.sigma_mm = 0.002;
      readings.push_back(r);
    }
  const GeometryFit fit = fit_geometry(GeometryModel({}, readings), {.switch_offsets_only = true});
  ASSERT_TRUE(fit.solved) << fit.problem;
  EXPECT_LT(fit.after_rms_mm, 0.003);
}

TEST(PoseSuggestion, ChosenPosesTellMoreThanRandomOnes) {
  Random random(9);
  std::vector<Pose> candidates;
  for (int n = 0; n < 150; ++n) candidates.push_back(random.pose());
  const auto poses = suggest_poses({}, {}, candidates, 20, 0.01, {});
  ASSERT_EQ(poses.size(), 20u);
  const auto quality = [&](const std::vector<Pose>& chosen) {
    double sum = 0;
    for (unsigned seed = 20; seed < 24; ++seed) {
      Random other(seed);
      const MachineDeviation truth = hidden(other);
      const GeometryModel model({}, measure(truth, chosen, 0.01, other));
      const GeometryFit fit = fit_geometry(model, {});
      sum += fit.solved ? error_rms(model, truth, fit.deviation, other) : 1;
    }
    return sum / 4;
  };
  const double chosen = quality(poses);
  const double drawn = quality({candidates.begin(), candidates.begin() + 20});
  EXPECT_LT(chosen, drawn);
}

}  // namespace
}  // namespace kinebus
