#include "tools/machine_setup/boards_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace kinebus {

std::string as_line(const BusBoard& one) {
  const std::string id = one.board.node_id != 0 ? fmt::format("node {}", one.board.node_id) : "no id";
  return fmt::format(
      "  {:<8} {:<20} serial number {:<11} {}\n", id, words_of(one.function), one.board.serial(),
      one.kind != nullptr
          ? one.kind->device_name
          : fmt::format("vendor {:08X}h, product {:08X}h", one.board.identity[0], one.board.identity[1]));
}

std::string as_lines(const UsbBoards& usb) {
  std::string text = "On USB:\n";
  if (!usb.trouble.empty()) text += fmt::format("  {}\n", usb.trouble);
  if (usb.trouble.empty() && usb.boards.empty()) text += "  no adapter and no board\n";
  for (const UsbBoard& one : usb.boards) {
    text += fmt::format("  bus {} device {:<3} {:04x}:{:04x} {}{}{}\n", one.bus, one.address, one.vendor,
                        one.product, words_of(one.kind), one.name.empty() ? "" : ": " + one.name,
                        one.serial.empty() ? "" : ", serial number " + one.serial);
    if (const std::string advice = usb_advice(one); !advice.empty()) text += fmt::format("  ! {}\n", advice);
  }
  return text;
}

std::string as_text(const BoardsReport& report) {
  std::string text = fmt::format("On {}:\n", report.interface);
  if (!report.bus_trouble.empty()) text += fmt::format("  {}\n", report.bus_trouble);
  for (const std::string& advice : report.advices) text += fmt::format("  {}\n", advice);
  if (report.bus_trouble.empty() && report.bus.empty())
    text +=
        "  no board answers: has it power, are both ends of the bus terminated, CAN high and low not "
        "exchanged?\n";
  for (const BusBoard& one : report.bus) text += as_line(one);
  for (const std::string& trouble : board_troubles(report.bus)) text += fmt::format("  ! {}\n", trouble);
  text += as_lines(report.usb);
  return text;
}

std::string as_json(const BoardsReport& report) {
  using Json = nlohmann::ordered_json;
  Json bus = Json::array(), usb = Json::array();
  for (const BusBoard& one : report.bus) {
    Json row{{"node", one.board.node_id != 0 ? Json(one.board.node_id) : Json(nullptr)},
             {"function", words_of(one.function)},
             {"name", one.name},
             {"vendor", one.board.identity[0]},
             {"product", one.board.identity[1]},
             {"revision", one.board.identity[2]},
             {"serial", one.board.serial()},
             {"shares_id", one.shares_id}};
    if (one.kind != nullptr) row["board"] = one.kind->name;
    bus.push_back(std::move(row));
  }
  for (const UsbBoard& one : report.usb.boards)
    usb.push_back({{"vendor", one.vendor},
                   {"product", one.product},
                   {"kind", words_of(one.kind)},
                   {"name", one.name},
                   {"serial", one.serial},
                   {"advice", usb_advice(one)}});
  const Json all{{"interface", report.interface},
                 {"bus_trouble", report.bus_trouble},
                 {"advices", report.advices},
                 {"bus", std::move(bus)},
                 {"troubles", board_troubles(report.bus)},
                 {"usb", std::move(usb)},
                 {"usb_trouble", report.usb.trouble}};
  // What a device says of itself need not be UTF-8.
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace kinebus
