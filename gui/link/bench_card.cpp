#include "gui/link/bench_card.hpp"

#include <sys/prctl.h>

#include <csignal>
#include <utility>

#include <QCoreApplication>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QIODevice>
#include <QJsonDocument>
#include <QLatin1Char>
#include <QLatin1String>
#include <QStandardPaths>

namespace kinebus::gui {
namespace {
constexpr int kPatience_ms = 3000;
}  // namespace

BenchCard::BenchCard(QString program, QObject* parent)
    : QObject(parent), program_(std::move(program)), process_(this) {
  connect(&process_, &QProcess::readyReadStandardOutput, this, &BenchCard::read);
  connect(&process_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
    if (error != QProcess::FailedToStart) return;
    wanted_ = false;
    emit ended(process_.errorString());
  });
  connect(&process_, &QProcess::finished, this, [this] {
    read();
    const QString said = QString::fromUtf8(process_.readAllStandardError()).trimmed();
    open_ = 0;
    const bool by_itself = wanted_;
    wanted_ = false;
    emit ended(!by_itself ? QString() : said.isEmpty() ? tr("kinebus-card has ended") : said);
  });
}

BenchCard::~BenchCard() {
  process_.disconnect(this);
  end();
  if (process_.state() == QProcess::NotRunning) return;
  if (!process_.waitForFinished(kPatience_ms)) process_.kill();
  process_.waitForFinished(kPatience_ms);
}

QString BenchCard::find_program() {
  QString beside = QCoreApplication::applicationDirPath() + QStringLiteral("/kinebus-card");
  if (QFileInfo(beside).isExecutable()) return beside;
  return QStandardPaths::findExecutable(QStringLiteral("kinebus-card"));
}

QStringList BenchCard::interfaces() {
  constexpr int kCan = 280;  // ARPHRD_CAN
  QStringList found;
  const QDir net(QStringLiteral("/sys/class/net"));
  for (const QString& name : net.entryList(QDir::Dirs | QDir::NoDotAndDotDot)) {
    QFile type(net.filePath(name) + QStringLiteral("/type"));
    if (type.open(QIODevice::ReadOnly) && type.readAll().trimmed().toInt() == kCan) found << name;
  }
  return found;
}

void BenchCard::start(const QString& can_interface, int node) {
  if (runs()) return;
  if (program_.isEmpty()) {
    emit ended(tr("the program kinebus-card was not found: install the package kinebus-cli"));
    return;
  }
  open_ = 0;
  wanted_ = true;
  process_.setChildProcessModifier([] { ::prctl(PR_SET_PDEATHSIG, SIGINT); });
  process_.start(program_, {QStringLiteral("--interface"), can_interface, QStringLiteral("--node"),
                            QString::number(node), QStringLiteral("session")});
}

void BenchCard::end() {
  wanted_ = false;
  process_.closeWriteChannel();
}

void BenchCard::send(const QString& line) {
  if (!runs()) return;
  // A stop is answered by the motion that it ends.
  if (line != QLatin1String("stop")) ++open_;
  process_.write((line + QLatin1Char('\n')).toUtf8());
}

void BenchCard::read() {
  while (process_.canReadLine()) take(process_.readLine());
}

void BenchCard::take(const QByteArray& line) {
  const QJsonObject news = QJsonDocument::fromJson(line).object();
  const QString what = news.value(QLatin1String("done")).toString();
  const bool answer = !what.isEmpty() || news.contains(QLatin1String("refused"));
  if (answer && what != QLatin1String("stop") && open_ > 0) --open_;
  if (!what.isEmpty()) emit done(what, news);
  if (news.contains(QLatin1String("refused"))) emit refused(news.value(QLatin1String("refused")).toString());
  if (news.contains(QLatin1String("silent"))) emit silent(news.value(QLatin1String("silent")).toString());
  if (news.contains(QLatin1String("state"))) emit state_told(news.value(QLatin1String("state")).toObject());
}

}  // namespace kinebus::gui
