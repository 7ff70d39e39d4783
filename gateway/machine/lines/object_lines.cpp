// Objects of the job that runs: which there are, and that one is left out.

#include <algorithm>

#include "gateway/gcode/letters.hpp"
#include "gateway/machine/core.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

using gcode::in_lower_case;

std::string_view trimmed(std::string_view text) {
  text = text.substr(0, text.find(';'));
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
    text.remove_suffix(1);
  return text;
}

}  // namespace

void Gateway::Core::report_objects(MachineStatus& s) const {
  const Runner& job = print_.runner();
  if (!job.active()) return;
  for (const std::string& name : print_.report().objects) s.objects.push_back({name, false});
  for (const gcode::PrintObject& object : job.objects()) {
    if (!object.excluded) continue;
    const std::string name = shown_name(object);
    for (ObjectStatus& known : s.objects) known.left_out |= known.name == name;
  }
}

Result<void, Refusal> Gateway::Core::on(command::ExcludeObject& asked) {
  const std::vector<std::string>& known = print_.report().objects;
  const std::string name = in_lower_case(asked.name);
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    std::string all;
    for (const std::string& object : known) {
      if (all.size() > 300) {
        all += " ...";
        break;
      }
      all += (all.empty() ? "" : ", ") + object;
    }
    if (known.empty()) return refused(say("the job names no objects"));
    return refused(say("the job has no object %1; it has %2", cut_text(asked.name, 200), all));
  }
  if (auto done = print_.runner().leave_out(name); !done) return refused(done.error());
  events_.message(now_, say("the object %1 is left out from line %2 on: what is before it is planned already",
                            name, print_.runner().lines_read() + 1));
  return {};
}

std::optional<Result<void, Refusal>> Gateway::Core::object_line(std::string_view line) {
  std::string_view text = trimmed(line);
  std::string name;
  const std::string small = in_lower_case(text);
  if (small.starts_with("exclude_object ")) {
    const std::size_t at = small.find("name=");
    if (at == std::string::npos)
      return Error<Refusal>(Refusal{say("%1 needs %2", "EXCLUDE_OBJECT", "NAME=")});
    std::string_view rest = text.substr(at + 5);
    const bool quoted = !rest.empty() && (rest.front() == '"' || rest.front() == '\'');
    name = quoted ? rest.substr(1, rest.find(rest.front(), 1) - 1) : rest.substr(0, rest.find(' '));
  } else if (small.starts_with("m486")) {
    const std::string_view rest = trimmed(std::string_view(small).substr(4));
    const bool digits = rest.size() > 1 && rest.find_first_not_of("0123456789", 1) == rest.npos;
    if (rest.empty() || rest.front() != 'p' || !digits)
      return Error<Refusal>(Refusal{say("while a job runs M486 takes P with the number of an object")});
    // One that M486 A has named goes by its name.
    name = rest.substr(1);
    for (const gcode::PrintObject& object : print_.runner().objects())
      if (std::to_string(object.number) == name) name = shown_name(object);
  } else {
    return std::nullopt;
  }
  return carry_out(command::ExcludeObject{name});
}

}  // namespace kinebus
