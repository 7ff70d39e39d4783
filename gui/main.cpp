// kinebus-gui: builds the parts, connects them, and loops.

#include <QApplication>
#include <QCommandLineOption>
#include <QCommandLineParser>
#include <QCoreApplication>
#include <QFileInfo>
#include <QGuiApplication>
#include <QPalette>
#include <QSettings>
#include <QStringList>
#include <QStyleHints>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "gui/views/connect_page.hpp"
#include "gui/views/jobs_page.hpp"
#include "gui/views/main_window.hpp"
#include "gui/views/scene_view.hpp"

namespace {

bool system_is_dark() {
  return QGuiApplication::palette().color(QPalette::Window).lightness() < 128;
}

// Platforms of Qt without widgets that draw by OpenGL: Qt itself would crash at the first picture. X11 and
// Wayland have them: where they lack a driver, the scene's place says so.
bool draws_without_opengl() {
  static const QStringList names{QStringLiteral("offscreen"), QStringLiteral("minimal"),
                                 QStringLiteral("vnc"), QStringLiteral("linuxfb")};
  return names.contains(QGuiApplication::platformName());
}

/// Only words are wanted, which need no display.
bool wants_words(int argc, char** argv) {
  return std::any_of(argv + 1, argv + argc, [](std::string_view word) {
    return word == "--help" || word == "-h" || word == "--help-all" || word == "--version" || word == "-v";
  });
}

int run(int argc, char** argv) {
  QCoreApplication::setOrganizationName(QStringLiteral("kinebus"));
  QCoreApplication::setApplicationName(QStringLiteral("kinebus-gui"));
  QCoreApplication::setApplicationVersion(QStringLiteral(KINEBUS_VERSION));
  std::unique_ptr<QCoreApplication> app;
  if (wants_words(argc, argv)) {
    app = std::make_unique<QCoreApplication>(argc, argv);
  } else {
    kinebus::gui::SceneView::choose_format();
    app = std::make_unique<QApplication>(argc, argv);
    QApplication::setDesktopFileName(QStringLiteral("kinebus-gui"));
  }

  QCommandLineParser arguments;
  arguments.setApplicationDescription(
      QStringLiteral("Kinebus: send a job to the gateway and watch the machine print."));
  arguments.addHelpOption();
  arguments.addVersionOption();
  const QCommandLineOption demo(QStringLiteral("demo"),
                                QStringLiteral("Start the simulated demo machine and connect to it."));
  const QCommandLineOption socket(QStringLiteral("socket"),
                                  QStringLiteral("Connect to the gateway that listens at this local socket."),
                                  QStringLiteral("PATH"));
  const QCommandLineOption language(QStringLiteral("language"), QStringLiteral("en, tr or fa."),
                                    QStringLiteral("CODE"));
  arguments.addOptions({demo, socket, language});
  arguments.addPositionalArgument(QStringLiteral("files"),
                                  QStringLiteral("G-code files to upload once connected."),
                                  QStringLiteral("[FILE...]"));
  arguments.process(*app);
  if (draws_without_opengl())
    throw std::runtime_error("Qt's platform \"" + QGuiApplication::platformName().toStdString() +
                             "\" has no OpenGL, which the 3D view needs; use X11 (xcb) or Wayland");

  QSettings settings;
  QStringList sockets;
  if (arguments.isSet(socket)) sockets << arguments.value(socket);
  kinebus::gui::Desk desk(sockets);
  desk.theme.apply(settings.value(QStringLiteral("theme/dark"), system_is_dark()).toBool());
  const QString saved =
      settings.value(QStringLiteral("language"), kinebus::gui::Language::system_code()).toString();
  desk.language.apply(arguments.isSet(language) ? arguments.value(language) : saved);

  kinebus::gui::MainWindow window(desk);
  window.restore(settings);
  window.show();
  if (arguments.isSet(demo)) {
    window.connect_page().start_demo();
  } else if (arguments.isSet(socket)) {
    kinebus::gui::FoundGateway gateway;
    gateway.way = kinebus::gui::FoundGateway::Way::kSocket;
    gateway.socket_path = QFileInfo(arguments.value(socket)).absoluteFilePath();
    gateway.title = kinebus::gui::Phrase(gateway.socket_path);
    desk.connect_to(gateway);
  }
  QStringList files = arguments.positionalArguments();
  QObject::connect(&desk.session, &kinebus::gui::Session::link_changed, &window, [&] {
    if (desk.session.connected() && !files.isEmpty()) window.jobs_page().upload(std::exchange(files, {}));
  });
  return QApplication::exec();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kinebus-gui: %s\n", error.what());
    return 1;
  }
}
