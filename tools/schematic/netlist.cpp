#include "tools/schematic/netlist.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>

#include "tools/schematic/sheet.hpp"

namespace kinebus::schematic {
namespace {

constexpr int kDeepestSheet = 10;

/// Sets of places that are connected.
class Joined {
 public:
  std::size_t add() {
    parent_.push_back(parent_.size());
    return parent_.size() - 1;
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

bool within(const std::array<Place, 2>& wire, Place p) {
  const auto [a, b] = wire;
  if (p == a || p == b) return false;
  const auto [left, right] = std::minmax(a.x, b.x);
  const auto [top, bottom] = std::minmax(a.y, b.y);
  return (a.x == b.x && p.x == a.x && p.y > top && p.y < bottom) ||
         (a.y == b.y && p.y == a.y && p.x > left && p.x < right);
}

class Builder {
 public:
  explicit Builder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  Result<Netlist, FileError> build(const std::filesystem::path& root) {
    auto sheet = read_sheet(root);
    if (!sheet) return Error<FileError>(sheet.error());
    references_ = sheet->references;
    std::map<std::string, std::size_t> outside;
    if (const auto error = add(*sheet, "", "/", outside, 0)) return Error<FileError>(*error);
    finish();
    return std::move(made_);
  }

 private:
  /// `outside`: the places of the pins of this sheet's box on the sheet above; empty for the root.
  std::optional<FileError> add(const Sheet& sheet, const std::string& path, const std::string& names,
                               const std::map<std::string, std::size_t>& outside, int depth) {
    if (depth == kDeepestSheet)
      return FileError{sheet.file, 0, "sheets within sheets: does one hold itself?"};
    std::map<Place, std::size_t> places;
    const auto at = [&](Place p) {
      const auto [found, fresh] = places.try_emplace(p, 0);
      if (fresh) found->second = nets_.add();
      return found->second;
    };
    const auto complain = [&](Place p, std::string words) {
      made_.complaints.push_back(fmt::format("{} at {:.2f}, {:.2f} mm: {}", names,
                                             static_cast<double>(p.x) / 1000, static_cast<double>(p.y) / 1000,
                                             words));
    };
    for (const auto& [a, b] : sheet.wires) nets_.join(at(a), at(b));
    // Labels and junctions hold on to the wires that pass below them; ends of wires and pins do not.
    const std::set<Place> junctions(sheet.junctions.begin(), sheet.junctions.end());
    const auto hold = [&](Place p) {
      bool wired = places.count(p) > 0;
      for (const auto& wire : sheet.wires)
        if (within(wire, p)) nets_.join(at(p), at(wire[0])), wired = true;
      return wired;
    };
    for (const Place p : sheet.junctions) hold(p);
    const auto look = [&](Place p, std::string_view what) {
      if (junctions.count(p)) return;
      for (const auto& wire : sheet.wires)
        if (within(wire, p)) complain(p, fmt::format("{} on the middle of a wire without a junction", what));
    };
    for (const auto& [a, b] : sheet.wires) look(a, "a wire ends"), look(b, "a wire ends");

    const std::size_t first_part = drawn_.size();
    for (const DrawnSymbol& symbol : sheet.symbols) {
      drawn_.push_back({symbol, path + "/" + symbol.uuid, names, {}});
      for (const DrawnPin& pin : symbol.pins) {
        look(pin.place, symbol.reference + " has a pin");
        drawn_.back().nodes.push_back(at(pin.place));
        if (symbol.power && pin.type == "power_in") name_globally(pin.name, at(pin.place));
      }
    }
    std::map<std::string, std::size_t> inside, local;
    const auto take = [&](const std::vector<Label>& labels, std::map<std::string, std::size_t>& known,
                          auto named) {
      for (const Label& label : labels) {
        if (!hold(label.place)) complain(label.place, fmt::format("label {} is on no wire", label.text));
        const std::size_t node = at(label.place);
        const auto [found, fresh] = known.try_emplace(label.text, node);
        if (!fresh) nets_.join(node, found->second);
        named(label.text, node);
      }
    };
    take(sheet.labels, local, [&](const std::string& text, std::size_t node) {
      named_.push_back({node, depth, names + text});
    });
    take(sheet.hierarchical_labels, inside, [&](const std::string& text, std::size_t node) {
      named_.push_back({node, depth, names + text});
    });
    std::map<std::string, std::size_t> global;
    take(sheet.global_labels, global,
         [&](const std::string& text, std::size_t node) { name_globally(text, node); });
    for (const auto& [text, node] : inside) {
      const auto found = outside.find(text);
      if (found != outside.end())
        nets_.join(node, found->second);
      else
        made_.complaints.push_back(
            fmt::format("{}: hierarchical label {} is no pin of the sheet's box", names, text));
    }
    for (const auto& [text, node] : outside)
      if (!inside.count(text))
        made_.complaints.push_back(
            fmt::format("{}: pin {} of the sheet's box has no label inside", names, text));

    const std::set<Place> unconnected(sheet.unconnected.begin(), sheet.unconnected.end());
    std::set<Place> used;
    for (std::size_t i = first_part; i < drawn_.size(); ++i)
      for (const DrawnPin& pin : drawn_[i].symbol.pins)
        if (unconnected.count(pin.place)) drawn_[i].marked.insert(pin.number), used.insert(pin.place);
    for (const Place p : unconnected)
      if (!used.count(p)) complain(p, "a mark of no connection is on no pin");

    for (const ChildSheet& child : sheet.children) {
      const auto below = read_sheet(folder_ / child.file);
      if (!below) return below.error();
      std::map<std::string, std::size_t> pins;
      for (const Label& pin : child.pins) {
        look(pin.place, "a sheet's pin");
        pins[pin.text] = at(pin.place);
      }
      if (auto error = add(*below, path + "/" + child.uuid, names + child.name + "/", pins, depth + 1))
        return error;
    }
    return std::nullopt;
  }

  void name_globally(const std::string& name, std::size_t node) {
    const auto [found, fresh] = global_.try_emplace(name, node);
    if (!fresh) nets_.join(node, found->second);
    named_.push_back({node, -1, name});
  }

  void finish() {
    std::map<std::size_t, std::size_t> numbers;  // of a set: its net
    std::map<std::string, std::size_t> parts;
    for (const Drawn& drawn : drawn_) {
      const DrawnSymbol& symbol = drawn.symbol;
      const auto placed = references_.find(drawn.path);
      const std::string reference = placed == references_.end() ? symbol.reference : placed->second;
      const auto [found, fresh] = parts.try_emplace(reference, made_.parts.size());
      if (fresh) {
        made_.parts.push_back({reference,
                               symbol.value,
                               symbol.symbol,
                               drawn.names,
                               symbol.in_bill && !symbol.power,
                               symbol.power,
                               symbol.properties,
                               {}});
      } else if (made_.parts[found->second].symbol != symbol.symbol ||
                 units_.count({reference, symbol.unit})) {
        made_.complaints.push_back(fmt::format("{} is used twice", reference));
        continue;
      }
      units_.insert({reference, symbol.unit});
      wanted_[reference] = symbol.units;
      Part& part = made_.parts[found->second];
      for (std::size_t i = 0; i < symbol.pins.size(); ++i) {
        const auto [number, first] = numbers.try_emplace(nets_.find(drawn.nodes[i]), made_.nets.size());
        if (first) made_.nets.emplace_back();
        made_.nets[number->second].pins.push_back({found->second, part.pins.size()});
        part.pins.push_back({symbol.pins[i].number, symbol.pins[i].name, symbol.pins[i].type, number->second,
                             drawn.marked.count(symbol.pins[i].number) > 0});
      }
    }
    for (const auto& [reference, count] : wanted_)
      for (int unit = 1; unit <= count; ++unit)
        if (!units_.count({reference, unit}))
          made_.complaints.push_back(fmt::format("unit {} of {} is not drawn", unit, reference));
    // A supply's name before a label's, a label of an upper sheet before one below.
    std::sort(named_.begin(), named_.end(), [](const Named& a, const Named& b) {
      return std::tie(a.depth, a.name) < std::tie(b.depth, b.name);
    });
    std::map<std::size_t, std::string> supply;
    for (const Named& named : named_) {
      const auto net = numbers.find(nets_.find(named.node));
      if (net == numbers.end()) {
        made_.complaints.push_back(fmt::format("{} leads to no pin", named.name));
        continue;
      }
      std::string& name = made_.nets[net->second].name;
      if (name.empty()) name = named.name;
      if (named.depth < 0 && name != named.name && supply[net->second] != named.name)
        made_.complaints.push_back(
            fmt::format("{} and {} are connected", name, supply[net->second] = named.name));
    }
    for (Net& net : made_.nets)
      if (net.name.empty()) {
        const auto [part, pin] = net.pins.front();
        net.name = made_.parts[part].reference + "." + made_.parts[part].pins[pin].number;
      }
  }

  struct Drawn {
    DrawnSymbol symbol;
    std::string path, names;
    std::vector<std::size_t> nodes;
    std::set<std::string> marked{};
  };
  struct Named {
    std::size_t node;
    int depth;
    std::string name;
  };
  std::filesystem::path folder_;
  Netlist made_;
  Joined nets_;
  std::vector<Drawn> drawn_;
  std::vector<Named> named_;
  std::map<std::string, std::size_t> global_;
  std::map<std::string, std::string> references_;
  std::set<std::pair<std::string, int>> units_;
  std::map<std::string, int> wanted_;
};

}  // namespace

std::string_view Part::property(const std::string& name) const {
  const auto found = properties.find(name);
  return found == properties.end() ? std::string_view() : std::string_view(found->second);
}

const PartPin* Part::pin(std::string_view number_or_name) const {
  for (const PartPin& pin : pins)
    if (pin.number == number_or_name) return &pin;
  for (const PartPin& pin : pins)
    if (pin.name == number_or_name) return &pin;
  return nullptr;
}

const Part* Netlist::part(std::string_view reference) const {
  for (const Part& part : parts)
    if (part.reference == reference) return &part;
  return nullptr;
}

const Net* Netlist::net_of(std::string_view reference, std::string_view pin) const {
  const Part* found = part(reference);
  const PartPin* end = found ? found->pin(pin) : nullptr;
  return end ? &nets[end->net] : nullptr;
}

Result<Netlist, FileError> read_netlist(const std::filesystem::path& root) {
  return Builder(root.parent_path()).build(root);
}

}  // namespace kinebus::schematic
