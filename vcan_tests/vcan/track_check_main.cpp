// Compares what the motors of the default machine really did, by the traces of its kinebus-vnode processes,
// with what the job plans: the tool's distance from the planned path, and the filament at every place of it.
//   kinebus-track-check JOB TRACE1 TRACE2 TRACE3 [--path-um 5] [--filament-mm 0.01] [--cut-at X Y Z] [--heat
//   TRACE --machine FILE]
// With --cut-at the traces begin after a power cut that came shortly after the tool was there: it must come
// back from above, not far behind that place, and go on to the path's end. With --heat the trace of a heat
// node beside it: whenever filament was fed the hot end was hot, and nothing was ever hotter than FILE's
// limits allow.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/gcode/interpreter.hpp"
#include "gateway/jobs/job_pipeline.hpp"
#include "gateway/jobs/machine_setup.hpp"
#include "gateway/jobs/store/file_source.hpp"
#include "protocol/host/guarded_main.hpp"
#include "tools/simulation/checkers/heat_checker.hpp"

namespace {

using namespace kinebus;

struct Arguments {
  std::string job;
  std::vector<std::string> traces;
  std::string heat, heat_machine;
  double path_um = 5, filament_mm = 0.01;
  std::vector<double> cut_at;
  double repeat_mm = 60, ahead_mm = 20, lift_mm = 5;
};

/// The planned path as a polyline, dense enough that chords are as good as arcs.
std::vector<Pose> planned(const MachineDescription& machine, const Kinematics& kinematics, ByteSource& job) {
  std::vector<Pose> points;
  JobPipeline pipeline(machine, kinematics);
  pipeline.start_job(job, kinematics.bed_reference());
  points.push_back(kinematics.bed_reference());
  for (;;) {
    int budget = 100;
    const auto step = pipeline.next(budget);
    if (step == JobPipeline::Step::kEnd) return points;
    if (step != JobPipeline::Step::kPhase) continue;
    const Phase& phase = pipeline.phase();
    const double length = phase.s(phase.duration_s) - phase.s0;
    const int pieces = static_cast<int>(std::ceil(std::max(2.0, length / 0.05)));
    for (int i = 1; i <= pieces; ++i) {
      const double share = static_cast<double>(i) / pieces;
      Pose pose = phase.piece.evaluate(phase.s0 + share * length).x;
      if (const auto machine_pose = convert_pose(kinematics, phase.piece.frame, pose, Frame::kMachine))
        pose = *machine_pose;
      points.push_back(pose);
    }
  }
}

using Samples = std::map<std::int64_t, std::array<std::int64_t, 2>>;

Samples read_trace(const std::string& path) {
  Samples samples;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return samples;
  std::array<std::int64_t, 3> row{};
  while (std::fread(row.data(), sizeof row, 1, file) == 1) samples[row[0]] = {row[1], row[2]};
  std::fclose(file);
  return samples;
}

/// Poses of the tool, machine frame, in the order of time. The traces count from power-up: homing has put the
/// joints' zero elsewhere, which the last positions tell, because the job's end is known.
std::vector<Pose> tool_track(const MachineDescription& machine, const Kinematics& kinematics,
                             const std::array<Samples, 3>& traces, const Pose& end) {
  const std::vector<NodeAxes> nodes = node_axes(machine);
  JointVector end_joints{};
  std::vector<Pose> track;
  if (!kinematics.inverse(Frame::kMachine, end, end_joints)) return track;
  std::vector<JointVector> joints;
  for (const auto& [time, first] : traces[0]) {
    JointVector values{};
    bool whole = true;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const auto found = traces[n].find(time);
      whole = whole && found != traces[n].end();
      for (std::size_t axis = 0; axis < 2 && whole; ++axis) {
        const AxisScaling& scaling = nodes[n].axes[axis];
        if (scaling.joint >= 0)
          values[static_cast<std::size_t>(scaling.joint)] = to_counts(found->second[axis]) / scaling.slope();
      }
    }
    if (whole) joints.push_back(values);
  }
  if (joints.empty()) return track;
  const JointVector last = joints.back();
  Pose pose = kinematics.bed_reference();
  for (JointVector values : joints) {
    for (std::size_t j = 0; j < machine.joints.size(); ++j) {
      // Whole counts: the zero is where a whole count is.
      values[j] += end_joints[j] - last[j];
    }
    if (kinematics.forward(Frame::kMachine, values, pose)) track.push_back(pose);
  }
  return track;
}

struct Nearest {
  double distance_mm = 1e9, filament_mm = 0;
  std::size_t at = 0;
};

/// A square of filament beside one of the path: what a micrometre or two of the tool leave open, the filament
/// decides, as where the tool stands and filament alone moves.
constexpr double kFilamentWeight = 0.2;

/// The nearest place of the path from `from` on, at most `ahead` points farther.
Nearest nearest(const std::vector<Pose>& path, std::size_t from, std::size_t ahead, const Pose& p) {
  Nearest best;
  double best_score = 1e9;
  for (std::size_t i = from; i + 1 < path.size() && i < from + ahead; ++i) {
    const Pose &a = path[i], &b = path[i + 1];
    double way = 0, along = 0;
    for (const std::size_t k : std::array<std::size_t, 4>{0, 1, 2, 5}) {
      const double weight = k == 5 ? kFilamentWeight : 1;
      way += weight * (b[k] - a[k]) * (b[k] - a[k]);
      along += weight * (b[k] - a[k]) * (p[k] - a[k]);
    }
    const double t = way > 0 ? std::clamp(along / way, 0.0, 1.0) : 0;
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double off = a[k] + t * (b[k] - a[k]) - p[k];
      square += off * off;
    }
    const double filament = p[kE] - (a[kE] + t * (b[kE] - a[kE]));
    const double score = square + kFilamentWeight * filament * filament;
    if (score >= best_score) continue;
    best_score = score;
    best = {std::sqrt(square), filament, i};
  }
  return best;
}

double length_mm(const std::vector<Pose>& path, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t i = from; i < to; ++i)
    sum += std::hypot(path[i + 1][kX] - path[i][kX], path[i + 1][kY] - path[i][kY],
                      path[i + 1][kZ] - path[i][kZ]);
  return sum;
}

/// After a power cut: backwards from the end as long as the tool is on the path, then what it came by.
int check_resumed(const Arguments& arguments, const std::vector<Pose>& path, const std::vector<Pose>& track) {
  std::vector<Nearest> places(track.size());
  std::size_t first = track.size(), at = path.size() - 1;
  while (first > 0) {
    const std::size_t from = at > 200 ? at - 200 : 0;
    const Nearest near = nearest(path, from, at - from + 20, track[first - 1]);
    if (near.distance_mm > 1e-3 * arguments.path_um || std::abs(near.filament_mm) > arguments.filament_mm)
      break;
    at = near.at;
    places[--first] = near;
  }
  if (first == track.size() || first == 0) return std::printf("the tool never came back to the path\n"), 1;
  // Still coming down.
  while (first + 1 < track.size() && track[first + 1][kZ] < track[first][kZ]) ++first;
  double worst_mm = 0, worst_filament_mm = 0;
  for (std::size_t i = first; i < track.size(); ++i) {
    worst_mm = std::max(worst_mm, places[i].distance_mm);
    worst_filament_mm = std::max(worst_filament_mm, std::abs(places[i].filament_mm));
  }
  // Down to the place: the higher the earlier, beside it by no more than a microstep makes.
  const Pose& place = track[first];
  double lift_mm = 0;
  for (std::size_t i = first; i > 0; --i) {
    const Pose& p = track[i - 1];
    if (std::hypot(p[kX] - place[kX], p[kY] - place[kY]) > 0.01 || p[kZ] - place[kZ] < lift_mm - 0.004) break;
    lift_mm = std::max(lift_mm, p[kZ] - place[kZ]);
  }
  Pose cut{};
  std::copy(arguments.cut_at.begin(), arguments.cut_at.end(), cut.begin());
  double best_mm = 1e9;
  std::size_t cut_near = 0;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (const double off = std::hypot(path[i][kX] - cut[kX], path[i][kY] - cut[kY], path[i][kZ] - cut[kZ]);
        off < best_mm)
      best_mm = off, cut_near = i;
  const double repeated_mm = cut_near >= at ? length_mm(path, at, cut_near) : -length_mm(path, cut_near, at);
  std::printf(
      "%zu samples after the power cut: down from %.2f mm above, %.1f mm of path before where the tool was\n"
      "seen last, path within %.2f um, filament within %.4f mm, to its end\n",
      track.size() - first, lift_mm, repeated_mm, worst_mm * 1e3, worst_filament_mm);
  const bool good = lift_mm > arguments.lift_mm - 0.1 && repeated_mm < arguments.repeat_mm &&
                    repeated_mm > -arguments.ahead_mm && best_mm < 0.5 && at + 20 < path.size();
  return good ? 0 : 1;
}

/// `feeder`: of the node that turns the extruder, its axis B.
bool check_heat(const Arguments& arguments, const Samples& feeder, double slope) {
  const auto machine = load_machine(arguments.heat_machine);
  if (!machine) return std::printf("%s\n", to_string(machine.error()).c_str()), false;
  HeatChecker checker(*machine);
  // Milli-degrees; the last sample before each of the motors'.
  const Samples heat = read_trace(arguments.heat);
  for (const auto& [time, positions] : feeder) {
    const auto next = heat.upper_bound(time);
    if (next == heat.begin()) continue;
    const auto& [hot_end, bed] = std::prev(next)->second;
    checker.on_sample(1e-9 * static_cast<double>(time),
                      {1e-3 * static_cast<double>(hot_end), 1e-3 * static_cast<double>(bed)},
                      to_counts(positions[1]) / slope);
  }
  if (!checker.has_fed()) return std::printf("no filament was fed\n"), false;
  std::printf("hot end at %.1f C or more while filament was fed, at most %.1f C; %.1f K below the limits\n",
              checker.coldest_c(), checker.hottest_c(), checker.nearest_k());
  if (!checker.complaint().empty()) std::printf("%s\n", checker.complaint().c_str());
  return checker.complaint().empty();
}

int check(const Arguments& arguments) {
  const MachineDescription machine = default_m1();
  const auto kinematics = make_kinematics(machine);
  auto job = FileSource::open(arguments.job);
  if (!kinematics || !job) return std::printf("cannot read %s\n", arguments.job.c_str()), 2;
  const std::vector<Pose> path = planned(machine, **kinematics, **job);
  std::array<Samples, 3> traces;
  for (std::size_t i = 0; i < traces.size(); ++i) traces[i] = read_trace(arguments.traces[i]);
  if (!arguments.heat.empty() && !check_heat(arguments, traces[2], node_axes(machine)[2].axes[1].slope()))
    return 1;
  const std::vector<Pose> track = tool_track(machine, **kinematics, traces, path.back());
  if (track.empty()) return std::printf("no samples of all three nodes\n"), 2;

  if (!arguments.cut_at.empty()) return check_resumed(arguments, path, track);

  // From the last time that the tool stood where the job begins.
  std::size_t begin = track.size();
  const Pose& start = path.front();
  const auto stands_at_start = [&](const Pose& p) {
    return std::hypot(p[kX] - start[kX], p[kY] - start[kY], p[kZ] - start[kZ]) < 0.004;
  };
  while (begin > 0 && !stands_at_start(track[begin - 1])) --begin;
  if (begin == 0) return std::printf("the tool never stood where the job begins\n"), 1;

  double worst_mm = 0, worst_filament_mm = 0;
  std::size_t at = 0, samples = 0;
  for (std::size_t i = begin - 1; i < track.size(); ++i, ++samples) {
    const Nearest near = nearest(path, at > 20 ? at - 20 : 0, 200, track[i]);
    at = std::max(at, near.at);
    worst_mm = std::max(worst_mm, near.distance_mm);
    worst_filament_mm = std::max(worst_filament_mm, std::abs(near.filament_mm));
  }
  const bool reached = at + 20 >= path.size();
  std::printf("%zu samples: path within %.2f um, filament within %.4f mm, %s\n", samples, worst_mm * 1e3,
              worst_filament_mm, reached ? "to its end" : "NOT to its end");
  const bool good =
      reached && worst_mm * 1e3 <= arguments.path_um && worst_filament_mm <= arguments.filament_mm;
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-track-check", [&] {
    Arguments arguments;
    CLI::App app("Compares the true positions of three virtual nodes with the path that a job plans.");
    app.add_option("job", arguments.job)->required();
    app.add_option("traces", arguments.traces)->required()->expected(3);
    app.add_option("--path-um", arguments.path_um)->capture_default_str();
    app.add_option("--filament-mm", arguments.filament_mm)->capture_default_str();
    app.add_option("--cut-at", arguments.cut_at, "Where the tool was when the power was cut, mm")
        ->expected(3);
    CLI::Option* limits =
        app.add_option("--machine", arguments.heat_machine, "Machine file with the heaters' limits");
    app.add_option("--heat", arguments.heat, "Trace of the heat node")->needs(limits);
    app.add_option("--repeat-mm", arguments.repeat_mm, "So much of the path is done again at most")
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return check(arguments);
  });
}
