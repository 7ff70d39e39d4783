#include "gui/link/demo_gateway.hpp"

#include <sys/prctl.h>

#include <csignal>

#include <QCoreApplication>
#include <QDir>
#include <QFileInfo>
#include <QLatin1Char>
#include <QStandardPaths>
#include <QStringList>
#include <QTimer>

namespace kinebus::gui {
namespace {
constexpr int kLook_ms = 30;
constexpr int kMaxLooks = 400;
constexpr int kEnd_ms = 3000;
}  // namespace

DemoGateway::DemoGateway(QObject* parent)
    : QObject(parent), folder_(QDir::tempPath() + QStringLiteral("/kinebus-demo-XXXXXX")), process_(this) {
  process_.setProcessChannelMode(QProcess::MergedChannels);
  connect(&process_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
    if (error == QProcess::FailedToStart) emit failed(process_.errorString());
  });
  connect(&process_, &QProcess::finished, this, [this] {
    const QString said = QString::fromUtf8(process_.readAll()).trimmed();
    emit failed(said.isEmpty() ? tr("the demo machine has ended") : said.section(QLatin1Char('\n'), -1));
  });
}

DemoGateway::~DemoGateway() {
  process_.disconnect(this);
  if (process_.state() == QProcess::NotRunning) return;
  process_.terminate();
  if (!process_.waitForFinished(kEnd_ms)) process_.kill();
  process_.waitForFinished(kEnd_ms);
}

QString DemoGateway::find_daemon() {
  QString beside = QCoreApplication::applicationDirPath() + QStringLiteral("/kinebusd");
  if (QFileInfo(beside).isExecutable()) return beside;
  return QStandardPaths::findExecutable(QStringLiteral("kinebusd"));
}

QString DemoGateway::socket_path() const {
  return folder_.filePath(QStringLiteral("kinebus.sock"));
}

void DemoGateway::start(const QString& machine_file) {
  const QString daemon = find_daemon();
  if (daemon.isEmpty() || !folder_.isValid()) {
    emit failed(daemon.isEmpty()
                    ? tr("the program kinebusd was not found: install the package kinebus-daemon")
                    : folder_.errorString());
    return;
  }
  QDir(folder_.path()).mkpath(QStringLiteral("jobs"));
  // The demo never outlives the program, however that ends.
  process_.setChildProcessModifier([] { ::prctl(PR_SET_PDEATHSIG, SIGTERM); });
  process_.setWorkingDirectory(folder_.path());
  const QStringList machine =
      machine_file.isEmpty()
          ? QStringList{QStringLiteral("--new-machine"), folder_.filePath(QStringLiteral("machine.toml"))}
          : QStringList{QStringLiteral("--machine"), machine_file};
  // In real time where the user may: on a busy computer the machine would be slow otherwise.
  process_.start(
      daemon, QStringList{QStringLiteral("--bus"), QStringLiteral("inproc"), QStringLiteral("--socket"),
                          socket_path(), QStringLiteral("--jobs"), folder_.filePath(QStringLiteral("jobs")),
                          QStringLiteral("--log-level"), QStringLiteral("warn")} +
                  machine);
  look_for_socket();
}

void DemoGateway::look_for_socket() {
  if (QFileInfo::exists(socket_path())) {
    emit ready();
    return;
  }
  if (process_.state() == QProcess::NotRunning) return;  // failed() has been told
  if (++looks_ > kMaxLooks) {
    emit failed(tr("the demo machine does not answer"));
    return;
  }
  QTimer::singleShot(kLook_ms, this, &DemoGateway::look_for_socket);
}

}  // namespace kinebus::gui
