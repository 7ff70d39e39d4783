// kinebus-workspace: what a machine can reach, and how well.

#include <CLI/CLI.hpp>
#include <bit>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/description/shipped_machines.hpp"
#include "protocol/host/guarded_main.hpp"
#include "protocol/host/step_line.hpp"
#include "protocol/host/usage.hpp"
#include "tools/workspace/bodies_picture.hpp"
#include "tools/workspace/boundary.hpp"
#include "tools/workspace/optimise_text.hpp"
#include "tools/workspace/picture.hpp"

namespace kinebus::workspace {
namespace {

struct Arguments {
  std::string machine, output, svg, bodies_svg, stl, ply;
  double step_mm = 4, tilt_step_deg = 3, dexterous = 8, legs_apart_mm = 40;
  int threads = 2;
  std::vector<double> wanted;  // radius, height, tilt from, tilt to
  bool optimise = false;
};

MachineDescription read_machine(const std::string& path) {
  if (path.empty()) return default_m1();
  auto machine = machine_of(path);
  if (!machine) throw std::runtime_error(machine.error());
  return std::move(*machine);
}

Room room_of(const MachineDescription& machine) {
  Room room;
  if (const PoseLimits* limits = pose_limits(machine.kinematics)) {
    if (limits->radius_mm > 0) room.radius_mm = limits->radius_mm;
    if (limits->z_mm.limited()) {
      room.z_min_mm = limits->z_mm.min;
      room.z_max_mm = limits->z_mm.max;
    }
    room.tilt_min_rad = limits->a_rad.min;
    room.tilt_max_rad = limits->a_rad.max;
  }
  return room;
}

void write(const std::string& path, const auto& what) {
  if (path.empty()) return;
  std::ofstream out(path, std::ios::binary);
  what(out);
  if (!out.flush()) throw std::runtime_error("cannot write " + path);
  std::printf("wrote %s\n", path.c_str());
}

/// Which rule of the machine's paper two bodies fall under.
const char* rule_of(bodies::BodyKind a, bodies::BodyKind b) {
  using K = bodies::BodyKind;
  const auto both = [&](auto&& first, auto&& second) {
    return (first(a) && second(b)) || (first(b) && second(a));
  };
  const auto rails = [](K k) { return k == K::kRail || k == K::kCarriage; };
  const auto platform = [](K k) { return k == K::kPlatform || k == K::kTable || k == K::kPart; };
  const auto leg = [](K k) { return k == K::kLeg; };
  if (both(platform, rails)) return "(b) platform against rail";
  if (both(leg, platform)) return "(d) leg against platform";
  if (both(leg, leg)) return "leg against leg";
  return "";
}

double table_radius_mm(const bodies::CollisionModel& model) {
  for (const auto& body : model.bodies())
    if (body.id.kind == bodies::BodyKind::kTable) {
      const bodies::Shape& s = model.at_rest().shapes[body.first_shape];
      // A bed that is a box: the circle in it.
      return s.core == bodies::Shape::Core::kBox ? std::min(norm(s.half[0]), norm(s.half[1])) : s.radius_mm;
    }
  return 0;
}

void print_meetings(const Scan& s, const bodies::CollisionModel* model) {
  if (model == nullptr) {
    std::printf("bodies               not checked: the machine file has no [bodies]\n");
    return;
  }
  if (s.meetings.empty())
    std::printf("bodies               keep %g mm apart at every pose left\n", model->wanted_mm());
  for (const Meeting& m : s.meetings)
    std::printf(
        "refused              %5.2f %% by %s and %s, nearest (%s) at X %.1f Y %.1f Z %.1f A %.1f  %s\n",
        100.0 * static_cast<double>(m.poses) / static_cast<double>(s.poses),
        model->name(m.worst.first).c_str(), model->name(m.worst.second).c_str(),
        m.worst.mm > 0 ? printed("%.2f mm", m.worst.mm).c_str() : "they touch", m.pose[kX], m.pose[kY],
        m.pose[kZ], m.pose[kA] / kRadPerDeg, rule_of(m.worst.first.kind, m.worst.second.kind));
}

void print_scan(const Scan& s, const bodies::CollisionModel* model) {
  std::printf("poses checked        %llu in %.2f s on %d threads, %.2f s of computing\n",
              static_cast<unsigned long long>(s.poses), s.seconds, s.options.threads, s.cpu_seconds);
  constexpr const char* kWhy[] = {"out of reach", "carriage travel", "leg angle",     "clearance",
                                  "pose limit",   "conditioning",    "no convergence"};
  for (std::size_t k = 0; k < std::size(kWhy); ++k)
    if (s.refused[k] > 0)
      std::printf("refused              %5.2f %% by %s\n",
                  100.0 * static_cast<double>(s.refused[k]) / static_cast<double>(s.poses), kWhy[k]);
  print_meetings(s, model);
  std::printf("volume at every tilt %.3f l\n\n", volume_mm3(s, -1) * 1e-6);
  std::printf(
      "  tilt   volume   largest upright cylinder\n   deg      l      diameter  height      z       "
      "volume\n");
  const auto row = [&](int tilt, const char* name) {
    const Cylinder c = largest_cylinder(s, tilt);
    std::printf("%6s %8.3f  %7.0f mm %6.0f mm  %4.0f..%-4.0f %7.3f l\n", name, volume_mm3(s, tilt) * 1e-6,
                2 * c.radius_mm, c.z_max_mm - c.z_min_mm, c.z_min_mm, c.z_max_mm, c.volume_mm3() * 1e-6);
  };
  for (int tilt = 0; tilt < s.tilts; ++tilt) {
    // Every fifth, and the level one.
    if (tilt % 5 != 0 && tilt != s.tilts - 1) continue;
    char name[16];
    // Rounded first: a tilt of -1e-15 is shown as 0.0, not as -0.0.
    std::snprintf(name, sizeof name, "%.1f", std::round(s.tilt_rad(tilt) / kRadPerDeg * 10) / 10 + 0.0);
    row(tilt, name);
  }
  row(-1, "every");
  const double table = model != nullptr ? table_radius_mm(*model) : s.room.radius_mm;
  const Cylinder c = standing_cylinder(s, table);
  std::printf("on a table of %.0f mm, at every tilt: %.0f mm diameter, %.0f mm high, from z %.0f\n",
              2 * table, 2 * c.radius_mm, c.z_max_mm - c.z_min_mm, c.z_min_mm);
}

/// Radius outwards, height upwards: tilts allowed all around, as a share.
void print_dexterity(const Scan& s) {
  std::printf(
      "\ndexterity: tilts allowed on the worst ray, tenths of all (* = all), condition <= %g counted\n",
      s.options.dexterous_condition);
  const int rows = 10, columns = 15;
  for (int i = rows - 1; i >= 0; --i) {
    const int plane = (2 * i + 1) * s.planes / (2 * rows);
    std::printf("%7.0f mm |", s.z_mm(plane));
    for (int k = 0; k < columns; ++k) {
      const int radius = (2 * k + 1) * s.radii / (2 * columns);
      int least = 64;
      for (int ray = 0; ray < s.rays; ++ray) {
        const std::size_t cell = s.cell(plane, ray, radius);
        const std::size_t looked = s.cell(plane - plane % 4, ray - ray % 4, radius - radius % 4);
        const bool well = s.worst_condition[looked] <= static_cast<float>(s.options.dexterous_condition);
        least = std::min(least, well ? std::popcount(s.allowed[cell]) : 0);
      }
      const int tenth = least == s.tilts ? 10 : 10 * least / s.tilts;
      std::printf(" %c", tenth == 10 ? '*' : tenth == 0 ? '.' : static_cast<char>('0' + tenth));
    }
    std::printf("\n");
  }
  std::printf("           +");
  for (int k = 0; k < columns; ++k) std::printf("--");
  std::printf("  radius 0 .. %.0f mm\n", s.room.radius_mm);
}

/// The machine found; an error where none keeps all rules, or the gateway would refuse it.
MachineDescription search(const Arguments& a, const MachineDescription& start, const Wish& wish) {
  const M1Geometry* before = four_legs(start);
  if (before == nullptr) throw std::runtime_error("--optimise is for machines of type m1");
  StepLine steps;
  const Optimised better = optimise(start, wish, {.threads = a.threads}, [&](double share) {
    steps.show("searching: " + std::to_string(std::lround(100 * share)) + " %");
  });
  steps.clear();
  const Room& room = wish.room;
  std::printf(
      "wanted: diameter %.0f mm, height %.0f .. %.0f mm, tilt %.0f .. %.0f deg; %d geometries tried\n",
      2 * room.radius_mm, room.z_min_mm, room.z_max_mm, room.tilt_min_rad / kRadPerDeg,
      room.tilt_max_rad / kRadPerDeg, better.tried);
  const M1Geometry& after = *four_legs(better.machine);
  const BodiesDescription& solid = *better.machine.bodies;
  std::printf("before, price %.3f:\n%s", better.before.price(*before),
              rules_text(better.before, *bodies::make_model(*before, solid)).c_str());
  const bodies::Model model = bodies::make_model(after, solid);
  std::printf("after, price %.3f:\n%s%s\n", better.after.price(after),
              rules_text(better.after, *model).c_str(), legs_text(after).c_str());
  if (!better.found())
    throw std::runtime_error("no machine was found that keeps all rules there; the nearest one has " +
                             broken_text(better.after, *model));
  // What the gateway would say to it, homing included.
  const std::string text = write_machine(better.machine);
  auto read = parse_machine(text, "the machine found");
  if (!read)
    throw std::runtime_error("the gateway would refuse the machine found:\n" + to_string(read.error()));
  write(a.output, [&](std::ostream& out) { out << text; });
  return std::move(*read);
}

int run(const Arguments& a) {
  MachineDescription machine = read_machine(a.machine);
  Room room = room_of(machine);
  if (!a.wanted.empty())
    room = {a.wanted[0], 0, a.wanted[1], a.wanted[2] * kRadPerDeg, a.wanted[3] * kRadPerDeg};
  if (a.optimise) {
    Wish wish;
    wish.legs_apart_mm = a.legs_apart_mm;
    if (!a.wanted.empty()) wish.room = room;
    room = wish.room;
    machine = search(a, machine, wish);
  }
  const auto kinematics = make_kinematics(machine);
  if (!kinematics) throw std::runtime_error(kinematics.error().what);
  ScanOptions options;
  options.step_mm = options.ray_step_mm = a.step_mm;
  options.tilt_step_rad = a.tilt_step_deg * kRadPerDeg;
  options.threads = a.threads;
  options.dexterous_condition = a.dexterous;
  const bodies::Model model = make_collision_model(machine);
  StepLine steps;
  const auto tell = [&](double share) {
    steps.show("looking at poses: " + std::to_string(std::lround(100 * share)) + " %");
  };
  const Scan fine = scan(**kinematics, room, options, model.get(), tell);
  steps.clear();
  std::printf("%s: radius %.0f mm, z %.0f .. %.0f mm, tilt %.0f .. %.0f deg; %g mm and %g deg\n",
              machine.name.c_str(), room.radius_mm, room.z_min_mm, room.z_max_mm,
              room.tilt_min_rad / kRadPerDeg, room.tilt_max_rad / kRadPerDeg, a.step_mm, a.tilt_step_deg);
  print_scan(fine, model.get());
  print_dexterity(fine);
  if (!a.svg.empty()) {
    ScanOptions wide = options;
    wide.step_mm = std::max(a.step_mm, room.radius_mm / 36);
    wide.ray_step_mm = 1.6 * wide.step_mm;
    const Scan coarse = scan(**kinematics, room, wide, model.get(), tell);
    steps.clear();
    char subtitle[256];
    const double table_mm = model != nullptr ? table_radius_mm(*model) : room.radius_mm;
    const Cylinder standing = standing_cylinder(fine, table_mm);
    std::snprintf(
        subtitle, sizeof subtitle,
        "%g mm and %g deg: %.1f million poses. Colour: share of the tilts allowed. On the table, at every "
        "tilt: a cylinder of %.0f mm by %.0f mm (outlined).",
        a.step_mm, a.tilt_step_deg, static_cast<double>(fine.poses) * 1e-6, 2 * standing.radius_mm,
        standing.z_max_mm - standing.z_min_mm);
    write(a.svg, [&](std::ostream& out) {
      out << draw_workspace(fine, coarse, {"Workspace of " + machine.name, subtitle, table_mm});
    });
  }
  if (!a.bodies_svg.empty()) {
    if (model == nullptr) throw std::runtime_error("--bodies-svg is for a machine file with [bodies]");
    write(a.bodies_svg, [&](std::ostream& out) {
      out << draw_bodies(*model, **kinematics, room, "Bodies of " + machine.name);
    });
  }
  if (!a.stl.empty() || !a.ply.empty()) {
    const auto triangles = boundary(fine, -1);
    write(a.stl, [&](std::ostream& out) { write_stl(out, triangles); });
    write(a.ply, [&](std::ostream& out) { write_ply(out, triangles); });
  }
  return 0;
}

}  // namespace
}  // namespace kinebus::workspace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-workspace", [&] {
    kinebus::workspace::Arguments a;
    CLI::App app("What a machine can reach: volume, cylinders, dexterity, picture and mesh");
    app.set_version_flag("--version", KINEBUS_VERSION);
    app.add_option("--machine", a.machine,
                   "Machine file, or the name of a shipped one; without it the default machine M1");
    app.add_option("--step", a.step_mm, "mm between places (default 4)")->check(CLI::Range(0.2, 50.0));
    app.add_option("--tilt-step", a.tilt_step_deg, "deg between tilts (default 3)")
        ->check(CLI::Range(0.5, 90.0));
    app.add_option("--threads", a.threads, "Default 2")->check(CLI::Range(1, 64));
    app.add_option("--dexterous", a.dexterous,
                   "Condition number up to which the dexterity map counts (default 8)");
    app.add_option("--svg", a.svg, "Picture");
    app.add_option("--bodies-svg", a.bodies_svg,
                   "Picture of the bodies at four poses, and which two are nearest");
    app.add_option("--stl", a.stl, "Boundary as binary STL");
    app.add_option("--ply", a.ply, "Boundary as PLY, coloured by the share of tilts");
    app.add_option("--wanted", a.wanted, "Another room: RADIUS HEIGHT TILT-FROM TILT-TO, mm and deg")
        ->expected(4);
    CLI::Option* optimise =
        app.add_flag("--optimise", a.optimise,
                     "Search a machine for that room (default 100 200 -45 45) that keeps every rule, bodies "
                     "among them; show which rule binds where, scan the result");
    app.add_option("--legs-apart", a.legs_apart_mm, "With --optimise: mm between two legs (default 40)")
        ->check(CLI::Range(0.0, 1000.0))
        ->needs(optimise);
    app.add_option("--write", a.output, "With --optimise: machine file of what was found")->needs(optimise);
    if (const auto end = kinebus::parse_arguments(app, argc, argv)) return *end;
    return kinebus::workspace::run(a);
  });
}
