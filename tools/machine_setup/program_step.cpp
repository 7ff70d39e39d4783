// Boards get their programs, by kinebus-flash: those that have none, or one of another use, before they get
// their ids, and the others when theirs is not the one at hand.

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "tools/card/node_sdo.hpp"
#include "tools/flash/program_file.hpp"
#include "tools/machine_setup/program_step.hpp"

namespace kinebus {
namespace {

constexpr ObjectAddress kProgramId{0x1F56, 1};

/// 1F56h of a node that is what the role is; nullopt: it does not tell. 0: no boot loader has started it.
std::optional<std::uint32_t> program_of(SetupState& s, const BoardRole& role, std::uint8_t node) {
  try {
    return static_cast<std::uint32_t>(
        NodeSdo(s.host.bus, node, find_board(role.kind->name)->objects).read(kProgramId));
  } catch (const CardError&) {
    return std::nullopt;
  }
}

/// The image's name, without .bin. It is asked for when it is needed: v1.1 has its heater at another pin.
std::string image_name(SetupState& s, const BoardRole& role) {
  static constexpr SetupChoice kVersions[] = {{"v1.2", ""}, {"v1.1", ""}};
  if (!role.has_versions) return role.program;
  const std::size_t version =
      s.kept_choice("ebb_version", fmt::format("Which version is printed on the {}?", role.name), kVersions);
  return role.program + (version == 0 ? "" : "-v1.1");
}

/// With its trouble where it is no program for that role.
ProgramFile load_program(const std::filesystem::path& file, const BoardRole& role) {
  ProgramFile program = read_program_file(file.string());
  if (!program.trouble.empty() || program.node_product == role.kind->product_code) return program;
  const BoardFacts* other = board_with_product(program.node_product);
  program.trouble = fmt::format("{}: found the program of {}; expected that of {}, {}.bin", program.file,
                                other != nullptr ? other->device_name : "another board",
                                role.kind->device_name, role.program);
  return program;
}

std::filesystem::path file_in(const std::filesystem::path& folder, const std::string& name) {
  return folder / (name + ".bin");
}

/// The images of the role that are at hand: of each version of the board.
std::vector<ProgramFile> at_hand(SetupState& s, const BoardRole& role) {
  std::vector<ProgramFile> found;
  for (const char* version : {"", "-v1.1"}) {
    if (*version != 0 && !role.has_versions) continue;
    std::error_code ignored;
    const auto file = file_in(s.host.programs, role.program + version);
    if (s.host.programs.empty() || !std::filesystem::exists(file, ignored)) continue;
    ProgramFile program = load_program(file, role);
    if (!program.trouble.empty())
      s.dialogue.say(program.trouble);
    else
      found.push_back(std::move(program));
  }
  return found;
}

/// What is to be written; nullopt: nothing. `what`: why.
std::optional<ProgramFile> choose_program(SetupState& s, const BoardRole& role, const std::string& what,
                                          bool at_hand) {
  if (at_hand) {
    ProgramFile program = load_program(file_in(s.host.programs, image_name(s, role)), role);
    if (program.trouble.empty())
      return s.dialogue.yes(role.name, fmt::format("{}Write {} to it over CAN?", what, program.file), true)
                 ? std::optional(std::move(program))
                 : std::nullopt;
    s.dialogue.say(program.trouble);
  }
  for (;;) {
    const std::string line =
        s.dialogue.line(fmt::format("{}Program for {} ({}.bin) to write over CAN; empty: it stays as it is",
                                    what, role.name, role.program));
    if (line.empty()) return std::nullopt;
    std::error_code ignored;
    std::filesystem::path file = line;
    if (std::filesystem::is_directory(file, ignored)) file = file_in(file, image_name(s, role));
    ProgramFile program = load_program(file, role);
    if (program.trouble.empty()) return program;
    s.dialogue.say(program.trouble);
  }
}

std::string written_key(const BusBoard& board) {
  return fmt::format("program_of_{}", board.board.serial());
}

/// The boards of the role's kind: one image for all of them.
std::vector<const BoardRole*> alike(const BoardPlan& plan, const BoardRole& role) {
  std::vector<const BoardRole*> roles;
  for (const BoardRole& other : plan.roles)
    if (other.kind == role.kind) roles.push_back(&other);
  return roles;
}

/// Those of the boards whose program is not one at hand. What cannot be changed over CAN is said.
std::vector<std::uint8_t> outdated(SetupState& s, const std::vector<const BoardRole*>& roles,
                                   const std::vector<ProgramFile>& files) {
  std::vector<std::uint8_t> nodes;
  for (const BoardRole* role : roles) {
    const auto crc = program_of(s, *role, role->first_id);
    if (!crc) continue;
    const bool same =
        std::any_of(files.begin(), files.end(), [&](const ProgramFile& file) { return file.crc == *crc; });
    if (same)
      s.dialogue.say(fmt::format("{}: it has the program that is at hand", role->name));
    else if (*crc == 0)
      s.dialogue.say(fmt::format(
          "{}: its program was not started by a boot loader, and is changed by DFU or SWD only (the "
          "board's page says how)",
          role->name));
    else
      nodes.push_back(role->first_id);
  }
  return nodes;
}

}  // namespace

bool offer_program(SetupState& s, const BoardRole& role, const BusBoard& board) {
  const std::string what = fmt::format(
      "{} ({}) {} ", board.kind->device_name, words_of(board),
      board.function == BoardFunction::kBootLoader
          ? fmt::format("waits in its boot loader without a program; it could be the {}.", role.name)
          : fmt::format("answers. If that is the {}, it wants the program for this use.", role.name));
  const auto program = choose_program(s, role, what, !at_hand(s, role).empty());
  if (!program) return false;
  if (!s.host.flash(program->file, {board.board.node_id}, true)) return false;
  s.answers.set(written_key(board), "written");
  return true;
}

bool keep_id_of_new_program(SetupState& s, NodeIds& ids, const BusBoard& board) {
  const std::string key = written_key(board);
  if (s.answers.get(key) != "written") return true;
  if (const std::string failed = ids.keep(board.board); !failed.empty())
    return s.dialogue.say(fmt::format("{}: {}", words_of(board), failed)), false;
  s.answers.set(key, "has its id");
  return true;
}

void offer_programs(SetupState& s) {
  if (s.answers.get("programs")) return;
  const BoardPlan plan = plan_of(s.first);
  for (const BoardRole& role : plan.roles) {
    const auto roles = alike(plan, role);
    if (roles.front() != &role) continue;
    const auto files = at_hand(s, role);
    std::vector<std::uint8_t> nodes;
    if (files.empty())
      for (const BoardRole* each : roles) nodes.push_back(each->first_id);
    else
      nodes = outdated(s, roles, files);
    while (!nodes.empty()) {
      const auto program = choose_program(
          s, role,
          files.empty() ? "\n"
                        : fmt::format("\n{}: its program is another one than that at hand. ", role.name),
          !files.empty());
      if (!program || s.host.flash(program->file, nodes, false)) break;
    }
  }
  s.answers.set("programs", "yes");
}

}  // namespace kinebus
