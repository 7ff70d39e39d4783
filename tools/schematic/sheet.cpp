#include "tools/schematic/sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

namespace kinebus::schematic {
namespace {

std::int64_t micrometres(double mm) {
  return std::llround(mm * 1000);
}
Place place_of(const Expression& item) {
  const Expression* at = item.find("at");
  return at ? Place{micrometres(at->number(1)), micrometres(at->number(2))} : Place{};
}

/// A symbol of the file's own library: pins where the symbol's origin is 0, y upwards.
struct LibrarySymbol {
  bool power = false;
  std::map<int, std::vector<DrawnPin>> units;  // 0: of every unit
};

// "NAME_UNIT_STYLE"
int unit_of(std::string_view name) {
  const std::size_t style = name.rfind('_');
  const std::size_t unit = style == std::string_view::npos ? style : name.rfind('_', style - 1);
  return unit == std::string_view::npos ? 0 : std::atoi(std::string(name.substr(unit + 1)).c_str());
}

LibrarySymbol read_library_symbol(const Expression& symbol) {
  LibrarySymbol made;
  made.power = symbol.find("power") != nullptr;
  for (const Expression& unit : symbol.items) {
    if (!unit.is("symbol")) continue;
    for (const Expression& pin : unit.items) {
      if (!pin.is("pin")) continue;
      const Expression* name = pin.find("name");
      const Expression* number = pin.find("number");
      made.units[unit_of(unit.at(1))].push_back({std::string(number ? number->at(1) : ""),
                                                 std::string(name ? name->at(1) : ""), std::string(pin.at(1)),
                                                 place_of(pin)});
    }
  }
  return made;
}

/// From the library's coordinates to the sheet's: y downwards, turned counter-clockwise, then mirrored.
Place placed(Place pin, Place origin, int degrees, std::string_view mirror) {
  Place turned;
  switch (degrees) {
    case 90:
      turned = {-pin.y, -pin.x};
      break;
    case 180:
      turned = {-pin.x, pin.y};
      break;
    case 270:
      turned = {pin.y, pin.x};
      break;
    default:
      turned = {pin.x, -pin.y};
  }
  if (mirror == "x") turned.y = -turned.y;
  if (mirror == "y") turned.x = -turned.x;
  return {origin.x + turned.x, origin.y + turned.y};
}

Result<DrawnSymbol, FileError> read_symbol(const Expression& item,
                                           const std::map<std::string, LibrarySymbol>& library,
                                           const std::string& file) {
  DrawnSymbol symbol;
  const Expression* id = item.find("lib_name");
  if (!id) id = item.find("lib_id");
  const auto found = library.find(std::string(id ? id->at(1) : ""));
  if (found == library.end())
    return Error<FileError>(FileError{
        file, item.line, fmt::format("no symbol \"{}\" in the file's lib_symbols", id ? id->at(1) : "")});
  symbol.symbol = found->first;
  symbol.power = found->second.power;
  symbol.units = 1;
  for (const auto& [unit, pins] : found->second.units) symbol.units = std::max(symbol.units, unit);
  if (const Expression* unit = item.find("unit")) symbol.unit = static_cast<int>(unit->number(1));
  if (const Expression* uuid = item.find("uuid")) symbol.uuid = uuid->at(1);
  if (const Expression* bill = item.find("in_bom")) symbol.in_bill = bill->at(1) == "yes";
  for (const Expression& property : item.items)
    if (property.is("property")) symbol.properties[std::string(property.at(1))] = property.at(2);
  symbol.reference = symbol.properties["Reference"];
  symbol.value = symbol.properties["Value"];
  const Expression* at = item.find("at");
  const Expression* mirror = item.find("mirror");
  for (const int unit : {0, symbol.unit}) {
    const auto pins = found->second.units.find(unit);
    if (pins == found->second.units.end()) continue;
    for (DrawnPin pin : pins->second) {
      pin.place = placed(pin.place, place_of(item), at ? static_cast<int>(at->number(3)) : 0,
                         mirror ? mirror->at(1) : "");
      symbol.pins.push_back(pin);
    }
  }
  return symbol;
}

ChildSheet read_child(const Expression& item) {
  ChildSheet child;
  if (const Expression* uuid = item.find("uuid")) child.uuid = uuid->at(1);
  for (const Expression& part : item.items) {
    if (part.is("pin")) child.pins.push_back({std::string(part.at(1)), place_of(part)});
    if (!part.is("property")) continue;
    if (part.at(1) == "Sheet name") child.name = part.at(2);
    if (part.at(1) == "Sheet file") child.file = part.at(2);
  }
  return child;
}

}  // namespace

Result<Sheet, FileError> read_sheet(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return Error<FileError>(FileError{file.string(), 0, "cannot be read"});
  const auto parsed = parse_expression(text.str(), file.string());
  if (!parsed) return Error<FileError>(parsed.error());
  if (!parsed->is("kicad_sch"))
    return Error<FileError>(FileError{file.string(), 1, "no schematic of KiCad 6 or later (kicad_sch)"});

  Sheet sheet;
  sheet.file = file.string();
  std::map<std::string, LibrarySymbol> library;
  if (const Expression* symbols = parsed->find("lib_symbols"))
    for (const Expression& symbol : symbols->items)
      if (symbol.is("symbol")) library[std::string(symbol.at(1))] = read_library_symbol(symbol);
  for (const Expression& item : parsed->items) {
    const auto label = [&] { return Label{std::string(item.at(1)), place_of(item)}; };
    if (item.is("wire")) {
      const Expression* points = item.find("pts");
      if (!points || points->items.size() != 3)
        return Error<FileError>(FileError{sheet.file, item.line, "a wire has two ends"});
      const auto end = [&](std::size_t i) {
        return Place{micrometres(points->items[i].number(1)), micrometres(points->items[i].number(2))};
      };
      sheet.wires.push_back({end(1), end(2)});
    } else if (item.is("junction")) {
      sheet.junctions.push_back(place_of(item));
    } else if (item.is("no_connect")) {
      sheet.unconnected.push_back(place_of(item));
    } else if (item.is("label")) {
      sheet.labels.push_back(label());
    } else if (item.is("global_label")) {
      sheet.global_labels.push_back(label());
    } else if (item.is("hierarchical_label")) {
      sheet.hierarchical_labels.push_back(label());
    } else if (item.is("sheet")) {
      sheet.children.push_back(read_child(item));
    } else if (item.is("symbol")) {
      auto symbol = read_symbol(item, library, sheet.file);
      if (!symbol) return Error<FileError>(symbol.error());
      sheet.symbols.push_back(std::move(*symbol));
    } else if (item.is("bus") || item.is("bus_entry")) {
      return Error<FileError>(FileError{sheet.file, item.line, "buses are not read: wires and labels are"});
    } else if (item.is("symbol_instances")) {
      for (const Expression& path : item.items)
        if (const Expression* reference = path.is("path") ? path.find("reference") : nullptr)
          sheet.references[std::string(path.at(1))] = reference->at(1);
    }
  }
  return sheet;
}

}  // namespace kinebus::schematic
