#include "gateway/run/bed_level.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinebus {
namespace {

using MeshWhat = canonical::Mesh::What;

std::string in_mm(double value) {
  return printed("%.3f", value);
}

double greatest(const MeshGrid& grid) {
  return std::max(std::abs(grid.lowest_mm()), std::abs(grid.highest_mm()));
}

}  // namespace

BedLevel::BedLevel(const MachineDescription& machine, LevelledKinematics& kinematics, journal::Queue& journal,
                   EventQueue& events, double unix_s_at_zero)
    : machine_(machine),
      levels_(kinematics),
      journal_(journal),
      events_(events),
      unix_s_at_zero_(unix_s_at_zero),
      identity_(identity(machine)),
      geometry_(geometry_mark(machine)) {}

const journal::Mesh* BedLevel::find(const std::string& name) const {
  const auto at =
      std::find_if(kept_.begin(), kept_.end(), [&](const journal::Mesh& mesh) { return mesh.name == name; });
  return at == kept_.end() ? nullptr : &*at;
}

void BedLevel::take_up(BusTime now, const journal::State& state) {
  kept_.clear();
  on_ = false;
  put_back();
  for (const journal::Mesh& mesh : state.meshes)
    if (mesh.machine == identity_ && mesh.grid.complete()) kept_.push_back(mesh);
  for (const journal::MeshInForce& named : state.meshes_in_force) {
    if (named.machine != identity_) continue;
    const journal::Mesh* const mesh = find(named.name);
    if (mesh == nullptr) continue;
    name_ = mesh->name;
    on_ = fits(*mesh);
    put_back();
    if (!on_)
      events_.message(now, say("the bed mesh %1 was measured with another geometry of the machine: it is not "
                               "used, measure the bed again",
                               mesh->name));
  }
}

bool BedLevel::moves_poses(const canonical::Mesh& command) {
  return command.what != MeshWhat::kKeep && command.what != MeshWhat::kForget &&
         command.what != MeshWhat::kTell && command.what != MeshWhat::kTellProbe;
}

void BedLevel::put(const MeshGrid& grid) {
  levels_.set_mesh(grid.complete() ? std::make_shared<const BedMesh>(grid) : nullptr);
}

void BedLevel::put_back() {
  const journal::Mesh* const mesh = on_ ? find(name_) : nullptr;
  levels_.set_mesh(mesh != nullptr ? std::make_shared<const BedMesh>(mesh->grid) : nullptr);
}

void BedLevel::use(std::string name, const MeshGrid& grid) {
  levels_.set_mesh(std::make_shared<const BedMesh>(grid));
  name_ = std::move(name);
  on_ = true;
  journal_.push(journal::MeshInForce{identity_, name_});
}

void BedLevel::turn_off() {
  on_ = false;
  levels_.set_mesh(nullptr);
  journal_.push(journal::MeshInForce{identity_, {}});
}

void BedLevel::keep(journal::Mesh mesh) {
  std::erase_if(kept_, [&](const journal::Mesh& old) { return old.name == mesh.name; });
  journal_.push(mesh);
  if (!mesh.grid.height_mm.empty()) kept_.push_back(std::move(mesh));
}

/// Why a bed of this shape is not printed on.
std::optional<Sentence> BedLevel::wrong(const MeshGrid& grid) const {
  if (greatest(grid) > machine_.mesh.limit_mm)
    return say(
        "the bed is %1 to %2 mm from the table of the machine file; mesh.limit_mm allows %3 mm: level it, "
        "or correct the machine file",
        in_mm(grid.lowest_mm()), in_mm(grid.highest_mm()), in_mm(machine_.mesh.limit_mm));
  if (grid.fade_mm > 0 && grid.fade_mm < BedMesh::kLeastFade * greatest(grid))
    return say("a mesh of up to %1 mm has to fade over at least %2 mm: found %3", in_mm(greatest(grid)),
               in_mm(BedMesh::kLeastFade * greatest(grid)), in_mm(grid.fade_mm));
  return std::nullopt;
}

Result<void, Sentence> BedLevel::carry_out(BusTime now, const canonical::Mesh& command,
                                           std::span<const Vector3> touched, std::uint32_t line) {
  switch (command.what) {
    case MeshWhat::kBegin:
    case MeshWhat::kOff:
      turn_off();
      return {};
    case MeshWhat::kEnd:
      return measured(now, command, touched, line);
    case MeshWhat::kOn:
      return turn_on(now, command, line);
    case MeshWhat::kForget:
      if (find(command.name) == nullptr) return Error<Sentence>(say("there is no mesh %1", command.name));
      keep({identity_, geometry_, command.name, 0, {}});
      return {};
    case MeshWhat::kTell:
      tell(now, line);
      return {};
    case MeshWhat::kTellProbe:
      if (!touched.empty())
        events_.message(now,
                        say("Bed X: %1 Y: %2 Z: %3", in_mm(touched.back()[0]), in_mm(touched.back()[1]),
                            in_mm(touched.back()[2])),
                        line);
      return {};
    case MeshWhat::kKeep:
    case MeshWhat::kFade:
    case MeshWhat::kPoint:
      break;
  }
  if (in_force() == nullptr) return Error<Sentence>(say("no bed mesh is in force"));
  MeshGrid grid = *in_force();
  if (command.what == MeshWhat::kKeep) {
    const journal::Mesh* const source = find(name_);
    keep({identity_, geometry_, command.name, source != nullptr ? source->unix_s : 0, std::move(grid)});
    return {};
  }
  if (command.what == MeshWhat::kFade) {
    grid.fade_mm = command.fade_mm;
    return change(std::move(grid));
  }
  if (command.points[0] >= grid.points[0] || command.points[1] >= grid.points[1])
    return Error<Sentence>(say("the mesh in force has %1 x %2 points", grid.points[0], grid.points[1]));
  float& height = grid.height_mm[grid.place(command.points[0], command.points[1])];
  height = static_cast<float>(command.value_mm + (command.adds ? double{height} : 0.0));
  return change(std::move(grid));
}

BedLevel::Done BedLevel::change(MeshGrid grid) {
  if (auto words = wrong(grid)) return Error<Sentence>(std::move(*words));
  const journal::Mesh* const source = find(name_);
  const double unix_s = source != nullptr ? source->unix_s : 0;
  use(name_, grid);
  keep({identity_, geometry_, name_, unix_s, std::move(grid)});
  return {};
}

BedLevel::Done BedLevel::turn_on(BusTime now, const canonical::Mesh& command, std::uint32_t line) {
  const std::string& asked = !command.name.empty() ? command.name : name_;
  const journal::Mesh* mesh = find(asked);
  if (mesh == nullptr && command.name.empty() && !kept_.empty()) mesh = &kept_.back();
  if (mesh == nullptr && !command.name.empty())
    return Error<Sentence>(say("there is no mesh %1", command.name));
  if (mesh == nullptr) {
    // As other firmware has it: M420 S1 stands in the start of jobs for beds that nobody has measured.
    events_.message(now, say("no bed mesh is kept: the bed is taken as even"), line);
    return {};
  }
  if (!fits(*mesh))
    return Error<Sentence>(
        say("the bed mesh %1 was measured with another geometry of the machine: it is not "
            "used, measure the bed again",
            mesh->name));
  journal::Mesh used = *mesh;
  if (command.fade_mm >= 0) used.grid.fade_mm = command.fade_mm;
  if (auto words = wrong(used.grid)) return Error<Sentence>(std::move(*words));
  const bool changed = used.grid.fade_mm != mesh->grid.fade_mm;
  use(used.name, used.grid);
  if (changed) keep(std::move(used));
  return {};
}

BedLevel::Done BedLevel::measured(BusTime now, const canonical::Mesh& command,
                                  std::span<const Vector3> touched, std::uint32_t line) {
  MeshGrid grid{command.points, command.from_mm, command.to_mm, machine_.mesh.fade_mm, {}};
  const auto columns = static_cast<std::size_t>(grid.points[0]);
  std::vector<std::optional<double>> heights(columns * static_cast<std::size_t>(grid.points[1]));
  for (const Vector3& at : touched) {
    std::array<std::size_t, 2> place{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double steps =
          (at[axis] - grid.from_mm[axis]) / (grid.to_mm[axis] - grid.from_mm[axis]) * (grid.points[axis] - 1);
      place[axis] = static_cast<std::size_t>(std::clamp(std::round(steps), 0.0, grid.points[axis] - 1.0));
    }
    heights[place[1] * columns + place[0]] = at[2];
  }
  for (const auto& height : heights) {
    if (!height) return Error<Sentence>(say("the bed was not measured as a whole"));
    grid.height_mm.push_back(static_cast<float>(*height));
  }
  if (grid.fade_mm > 0) grid.fade_mm = std::max(grid.fade_mm, BedMesh::kLeastFade * greatest(grid));
  if (auto words = wrong(grid)) return Error<Sentence>(std::move(*words));
  use(command.name, grid);
  keep({identity_, geometry_, command.name, unix_s_at_zero_ + to_seconds(now), std::move(grid)});
  tell(now, line);
  return {};
}

void BedLevel::tell(BusTime now, std::uint32_t line) {
  const MeshGrid* const grid = in_force();
  if (grid == nullptr) return events_.message(now, say("no bed mesh is in force"), line);
  events_.message(now,
                  say("bed mesh %1: %2 x %3 points, %4 to %5 mm", name_, grid->points[0], grid->points[1],
                      in_mm(grid->lowest_mm()), in_mm(grid->highest_mm())),
                  line);
}

}  // namespace kinebus
