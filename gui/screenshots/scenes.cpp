#include "gui/screenshots/scenes.hpp"

#include <QLatin1String>
#include <cmath>
#include <numbers>

#include "gui/views/console_page.hpp"
#include "gui/views/view_page.hpp"

namespace kinebus::gui {
namespace {

void whole_machine(MainWindow& window, Photographer& photographer, const QString& name) {
  SceneView& scene = window.view_page().scene();
  scene.look(SceneView::Look::kDiagonal);
  scene.fit_machine();
  photographer.one(MainWindow::kView, name);
}

/// Again until it is taken: one that comes while the machine still moves may be refused.
void go(Desk& desk, const char* line) {
  bool taken = false, asked = false;
  wait(line, [&] {
    if (!asked && desk.session.status().state() == joblink::STATE_READY) {
      asked = true;
      desk.session.console(QString::fromLatin1(line),
                           [&](const joblink::Reply& reply) { asked = taken = !reply.has_error(); });
    }
    return taken;
  });
}

void around_the_part(MainWindow& window, Photographer& photographer, const QString& name) {
  window.view_page().scene().fit_part();
  photographer.one(MainWindow::kView, name);
}

}  // namespace

void turn_to(Desk& desk, const char* machine) {
  desk.start_demo([](const QString& why) { std::fprintf(stderr, "%s\n", qPrintable(why)); },
                  QStringLiteral(KINEBUS_MACHINES "/%1.toml").arg(QLatin1String(machine)));
  wait(machine, [&] { return desk.session.connected() && desk.session.machine().joints_size() > 0; });
}

void say_line(Desk& desk, MainWindow& window, const char* line) {
  window.console_page().send(QString::fromLatin1(line));
  wait(line, [&, from = desk.session.status().time_s()] {
    return desk.session.status().time_s() > from + 0.3 &&
           desk.session.status().state() == joblink::STATE_READY;
  });
}

void photograph_m1(Desk& desk, MainWindow& window, Photographer& photographer) {
  const auto state = [&] { return desk.session.status().state(); };
  whole_machine(window, photographer, QStringLiteral("11-scene-m1-home"));
  desk.session.go_to_reference();
  wait("it is over the bed", [&] { return state() == joblink::STATE_MOVING; });
  wait("it rests", [&] { return state() == joblink::STATE_READY; });
  constexpr double kTilt_rad = std::numbers::pi / 4;
  joblink::Pose tilt;
  tilt.set_a_rad(kTilt_rad);
  desk.session.jog(tilt, 0);
  wait("it is tilted", [&] {
    return state() == joblink::STATE_READY &&
           std::abs(desk.session.status().tool().a_rad() - kTilt_rad) < 1e-3;
  });
  whole_machine(window, photographer, QStringLiteral("11-scene-m1-tilted"));
  around_the_part(window, photographer, QStringLiteral("11-scene-m1-tilted-part"));
  // Past the corner where leg 3 carries the platform, which comes within 3 mm of the nozzle there.
  for (const char* line : {"G90", "G43.4", "G1 Z60 F3000", "G1 A45", "G1 X-124 Y-40", "G1 Z4", "G1 Y-72"})
    go(desk, line);
  // Asked anew each time: every status is another one.
  wait("leg and nozzle are close", [&] {
    const auto& tool = desk.session.status().tool();
    return std::abs(tool.x_mm() + 124) < 0.1 && std::abs(tool.y_mm() + 72) < 0.1;
  });
  whole_machine(window, photographer, QStringLiteral("11-scene-m1-close"));
  around_the_part(window, photographer, QStringLiteral("11-scene-m1-close-part"));
  for (const char* line : {"G1 Z60", "G1 A0", "G49"}) go(desk, line);
  desk.session.go_to_reference();
  wait("it is upright", [&] {
    return state() == joblink::STATE_READY && std::abs(desk.session.status().tool().a_rad()) < 1e-3;
  });
}

void photograph_other_machines(Desk& desk, MainWindow& window, Photographer& photographer) {
  for (const char* machine : {"m2", "m3", "m4", "m5", "delta"}) {
    turn_to(desk, machine);
    desk.session.home();
    wait("it is homed", [&] {
      return desk.session.status().state() == joblink::STATE_READY && desk.session.status().positions_known();
    });
    whole_machine(window, photographer, QStringLiteral("11-scene-%1-home").arg(QLatin1String(machine)));
  }
}

}  // namespace kinebus::gui
