#include "gui/screenshots/killed_gateway.hpp"

#include <QProcess>
#include <QStringList>
#include <QTemporaryDir>

#include "gui/link/demo_gateway.hpp"
#include "gui/link/gateway_finder.hpp"
#include "gui/screenshots/demo_job.hpp"
#include "gui/views/jobs_page.hpp"
#include "gui/views/view_page.hpp"

namespace kinebus::gui {

void photograph_killed_gateway(Desk& desk, MainWindow& window, Photographer& photographer) {
  QTemporaryDir folder;
  FoundGateway found;
  found.way = FoundGateway::Way::kSocket;
  found.socket_path = folder.filePath(QStringLiteral("kinebus.sock"));
  found.title = {"kinebus::gui::GatewayFinder",
                 QT_TRANSLATE_NOOP("kinebus::gui::GatewayFinder", "Gateway on this computer")};
  QProcess daemon;
  const auto start = [&] {
    daemon.start(
        DemoGateway::find_daemon(),
        QStringList{QStringLiteral("--bus"), QStringLiteral("inproc"), QStringLiteral("--socket"),
                    found.socket_path, QStringLiteral("--jobs"), folder.filePath(QStringLiteral("jobs")),
                    QStringLiteral("--log-level"), QStringLiteral("warn")});
  };
  window.set_theme(false);
  window.set_language(QStringLiteral("en"));
  start();
  desk.connect_to(found);
  const auto state = [&] { return desk.session.status().state(); };
  wait("a gateway of its own", [&] { return desk.session.connected(); });
  window.jobs_page().upload({write_file(folder.path(), QStringLiteral("vase.gcode"), vase_job(44, 1, 0.7))});
  wait("it has the job", [&] { return desk.session.jobs().jobs_size() == 1; });
  desk.session.home();
  wait("it is homed",
       [&] { return state() == joblink::STATE_READY && desk.session.status().positions_known(); });
  desk.session.start_job(QStringLiteral("vase.gcode"));
  window.show_page(MainWindow::kView);
  wait("it prints",
       [&] { return state() == joblink::STATE_RUNNING && desk.session.status().progress() > 0.1; });
  const joblink::Status before = desk.session.status();
  daemon.kill();
  daemon.waitForFinished();
  wait("the window sees it", [&] { return desk.session.link_state() == Session::LinkState::kLost; });
  photographer.at_once(QStringLiteral("14-killed-1-at-once"));
  start();
  wait("it is back", [&] { return desk.session.connected() && desk.session.status().interrupted(); });
  photographer.at_once(QStringLiteral("14-killed-2-back"));
  std::printf("line %u and %.2f %% before, line %u and %.2f %% after\n", before.line(),
              100 * before.progress(), desk.session.status().line(), 100 * desk.session.status().progress());
  desk.session.resume();
  wait("the job goes on", [&] {
    return state() == joblink::STATE_RUNNING && desk.session.status().line() > before.line() &&
           !desk.session.status().interrupted();
  });
  photographer.at_once(QStringLiteral("14-killed-3-goes-on"));
  desk.session.disconnect_from_gateway();
  daemon.kill();
  daemon.waitForFinished();
}

}  // namespace kinebus::gui
