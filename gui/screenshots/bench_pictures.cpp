#include "gui/screenshots/bench_pictures.hpp"

#include <QFileDevice>
#include <QTemporaryDir>

#include "gui/views/bench_window.hpp"
#include "gui/views/connect_page.hpp"

namespace kinebus::gui {
namespace {

/// What kinebus-card's session tells of a card whose motor A holds. A real one needs a CAN interface, which
/// few computers that make pictures have.
constexpr const char* kCard = R"card(#!/bin/sh
a='{"drive": "operation enabled", "has_power": true, "position_known": true, "position_counts": 76800, "run_ma": 1500, "hold_ma": 800, "measured_ma": 790, "stage_celsius": 41.5, "supply_volts": 24.1, "error_code": 0}'
b='{"drive": "fault", "has_power": false, "position_known": false, "position_counts": 0, "run_ma": 900, "hold_ma": 300, "measured_ma": 0, "stage_celsius": 30, "supply_volts": 24.1, "error_code": 8976}'
off='{"active": false, "function": ""}'
echo '{"state": {"name": "Kinebus two-axis node", "serial": 77, "motors": ['"$a, $b"'], "switches": [{"active": true, "function": "home A"}, '"$off, $off, $off, $off, $off, $off"'], "errors": [8976]}}'
while read -r line; do :; done
)card";

}  // namespace

void photograph_bench(Desk& desk, MainWindow& window, Photographer& photographer) {
  photographer.bench(window.connect_page().show_bench(), QStringLiteral("14-bench"));
  const QTemporaryDir folder;
  const QString program = write_file(folder.path(), QStringLiteral("card"), kCard);
  QFile::setPermissions(program, QFileDevice::ReadOwner | QFileDevice::WriteOwner | QFileDevice::ExeOwner);
  BenchWindow opened(desk.theme, program);
  opened.show();
  bool told = false;
  QObject::connect(&opened.card(), &BenchCard::state_told, &opened, [&] { told = true; });
  opened.card().start(QStringLiteral("can0"), 1);
  wait("a card is open", [&] { return told; });
  photographer.bench(opened, QStringLiteral("14-bench-open"));
}

}  // namespace kinebus::gui
