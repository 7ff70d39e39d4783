// The program's arguments, and its answers as a table or as JSON.

#include <CLI/CLI.hpp>
#include <cmath>
#include <fstream>

#include "gateway/description/shipped_machines.hpp"
#include "tools/kinematics/commands.hpp"

namespace kinebus::kinematics_tool {
namespace {

struct Arguments {
  std::string machine = "m1", frame = "part", file;
  bool json = false, mirrored = false;
  std::vector<std::string> values;
};

constexpr int kColumn = 15;

std::string cell(double value) {
  // Residuals are shown as such, and never "-0.000000".
  if (value != 0 && std::abs(value) < 1e-5) return printed("%.2e", value);
  return printed("%.6f", value == 0 ? 0.0 : value);
}

void print_line(std::ostream& out, const std::vector<std::string>& cells, const std::string& remark) {
  std::string line;
  for (const std::string& text : cells)
    line +=
        std::string(std::max<std::size_t>(1, kColumn - std::min<std::size_t>(kColumn, text.size())), ' ') +
        text;
  if (!remark.empty()) line += (line.empty() ? "# " : "  # ") + remark;
  out << line << '\n';
}

/// How many poses cannot be taken.
int print_table(std::ostream& out, const Command& command, const Subject& subject,
                const std::vector<std::pair<NumberRow, Answer>>& answers) {
  std::vector<std::string> header = command.result_columns(subject);
  print_line(out, header, subject.machine().name + ", " + command.name);
  int failed = 0;
  for (const auto& [row, answer] : answers) {
    const bool block = answers.size() > 1 && (answer.lines.size() > 1 || answer.error);
    if (block)
      print_line(out, {}, "line " + std::to_string(row.line) + (answer.error ? ": " + *answer.error : ""));
    failed += answer.error ? 1 : 0;
    for (const Answer::Line& line : answer.lines) {
      std::vector<std::string> cells;
      for (const double value : line.values) cells.push_back(cell(value));
      print_line(out, cells, line.remark);
    }
  }
  return failed;
}

int print_json(std::ostream& out, const Command& command, const Subject& subject, const std::string& frame,
               const std::vector<std::pair<NumberRow, Answer>>& answers) {
  Json json{{"machine", subject.machine().name}, {"command", command.name}, {"frame", frame}};
  json["rows"] = Json::array();
  int failed = 0;
  for (const auto& [row, answer] : answers) {
    Json one = Json::object();
    if (row.line > 0) one["line"] = row.line;
    one.update(answer.json);
    json["rows"].push_back(std::move(one));
    failed += answer.error ? 1 : 0;
  }
  out << json.dump(1) << '\n';
  return failed;
}

Result<std::vector<NumberRow>, std::string> rows_of(const Arguments& a, const NumberColumns& columns,
                                                    std::istream& in) {
  if (!a.values.empty()) {
    if (!a.file.empty())
      return Error<std::string>("values on the command line and --in: expected one of them");
    auto row = number_row(a.values, columns);
    if (!row) return Error<std::string>(row.error());
    return std::vector<NumberRow>{std::move(*row)};
  }
  if (a.file.empty() || a.file == "-") return number_table(in, "standard input", columns);
  std::ifstream file(a.file, std::ios::binary);
  if (!file) return Error<std::string>(a.file + ": cannot be read");
  return number_table(file, a.file, columns);
}

Result<int, std::string> execute(const Command& command, const Arguments& a, std::istream& in,
                                 std::ostream& out, std::ostream& err) {
  auto machine = machine_of(a.machine);
  if (!machine) return Error<std::string>(machine.error());
  const auto subject = Subject::of(std::move(*machine));
  if (!subject) return Error<std::string>(a.machine + ": " + subject.error());
  if (a.mirrored && std::string_view(command.name) != "forward")
    return Error<std::string>("--mirrored is for forward");
  if (a.mirrored && !std::holds_alternative<M4Geometry>(subject->machine().kinematics))
    return Error<std::string>("--mirrored: " + subject->machine().name +
                              " has no part that could be mounted mirrored; expected a machine of type m4");
  if (command.of_bodies && subject->collision_model() == nullptr)
    return Error<std::string>(a.machine +
                              ": nobody knows what is solid; expected a table [bodies] in the machine file, "
                              "whose keys all have defaults");
  auto rows = rows_of(a, command.columns(*subject), in);
  if (!rows) return Error<std::string>(rows.error());
  std::vector<std::pair<NumberRow, Answer>> answers;
  for (NumberRow& row : *rows) {
    Answer answer = command.answer(
        {*subject, a.frame == "part" ? Frame::kPart : Frame::kMachine, a.mirrored, row.values});
    answers.emplace_back(std::move(row), std::move(answer));
  }
  const int failed = a.json ? print_json(out, command, *subject, a.frame, answers)
                            : print_table(out, command, *subject, answers);
  if (failed == 0) return 0;
  for (const auto& [row, answer] : answers) {
    if (!answer.error) continue;
    err << "kinebus-kinematics: " << command.name << ": ";
    if (row.line > 0) err << "line " << row.line << ": ";
    err << *answer.error;
    if (answers.size() > 1) err << " (" << failed << " of " << answers.size() << " rows have no answer)";
    err << '\n';
    break;
  }
  return 1;
}

}  // namespace

int run(std::vector<std::string> arguments, std::istream& in, std::ostream& out, std::ostream& err) {
  CLI::App app(
      "Positions, speeds and accelerations of any machine, for any numbers. Lengths in mm, angles in deg.",
      "kinebus-kinematics");
  app.require_subcommand(1);
  app.footer(
      "Without values a table is read: a row a pose, blanks or commas between values, # begins a comment, a "
      "first\n"
      "line may name the columns. What is printed can be read again: inverse > joints.txt, forward --in "
      "joints.txt.\n"
      "The paper's table 6 of M4: kinebus-kinematics forward --machine m4 932.6 1029.4 283.4 --mirrored");
  Arguments a;
  const Command* chosen = nullptr;
  for (const Command& command : commands()) {
    CLI::App* sub = app.add_subcommand(command.name, command.what);
    sub->add_option("values", a.values, "One row of values; none: --in");
    sub->add_option("--machine", a.machine, "Machine file, or the name of a shipped one (default m1)");
    sub->add_option("--in", a.file, "Table of rows; -, or without values: standard input");
    sub->add_option(
           "--frame", a.frame,
           "What X Y Z are: in the turning part (part, default) or along the machine's axes (machine)")
        ->check(CLI::IsMember({"part", "machine"}));
    sub->add_flag("--json", a.json, "The answer as JSON");
    if (std::string_view(command.name) == "forward")
      sub->add_flag("--mirrored", a.mirrored, "Also assemblies of the mirrored tool triangle (type m4)");
    sub->callback([&chosen, &command] { chosen = &command; });
  }
  // CLI11 takes "-.5" for an option, "-0.5" for a value.
  for (std::string& word : arguments)
    if (word.starts_with("-.")) word.insert(1, "0");
  std::reverse(arguments.begin(), arguments.end());
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    return app.exit(error, out, err) == 0 ? 0 : 2;
  }
  const auto code = execute(*chosen, a, in, out, err);
  if (code) return *code;
  err << "kinebus-kinematics: " << chosen->name << ": " << code.error() << '\n';
  return 1;
}

}  // namespace kinebus::kinematics_tool
