#pragma once
// Waits for the machine, and takes pictures of the window.

#include <QCoreApplication>
#include <QDeadlineTimer>
#include <QDir>
#include <QEventLoop>
#include <QFile>
#include <QIODevice>
#include <QLatin1String>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>

#include "gui/views/bench_window.hpp"
#include "gui/views/main_window.hpp"

namespace kinebus::gui {

inline void wait(const char* what, const std::function<bool()>& holds) {
  constexpr int kPatience_ms = 300'000;
  std::printf("%s\n", what);
  std::fflush(stdout);
  const QDeadlineTimer deadline(kPatience_ms);
  while (!holds()) {
    if (deadline.hasExpired()) throw std::runtime_error(std::string("waited in vain: ") + what);
    QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents | QEventLoop::AllEvents, 50);
  }
}

inline QString write_file(const QString& folder, const QString& name, const QByteArray& text) {
  QFile file(folder + QLatin1Char('/') + name);
  if (!file.open(QIODevice::WriteOnly))
    throw std::runtime_error("cannot write " + file.fileName().toStdString());
  file.write(text);
  return file.fileName();
}

class Photographer {
 public:
  Photographer(Desk& desk, MainWindow& window, QString folder)
      : desk_(desk), window_(window), folder_(std::move(folder)) {}

  void all(MainWindow::Page page, const QString& name, const std::function<void()>& prepare = {}) {
    for (const auto& choice : Language::choices())
      for (const bool dark : {false, true}) {
        window_.set_theme(dark);
        window_.set_language(choice.code);
        window_.show_page(page);
        if (prepare) prepare();
        take(QStringLiteral("%1-%2-%3")
                 .arg(name, choice.code, dark ? QStringLiteral("dark") : QStringLiteral("light")));
      }
  }

  /// What is the same in every language.
  void one(MainWindow::Page page, const QString& name) {
    window_.set_theme(false);
    window_.set_language(QStringLiteral("en"));
    window_.show_page(page);
    take(name);
  }

  /// Every page on a screen of 1024 x 640, in every language; a picture of each name once.
  void small(MainWindow::Page page, const QString& name) {
    const QSize before = window_.size();
    window_.set_theme(false);
    window_.resize(1024, 640);
    for (const auto& choice : Language::choices()) {
      window_.set_language(choice.code);
      window_.show_page(page);
      take(QStringLiteral("13-small-%1-%2").arg(name, choice.code));
    }
    window_.resize(before);
  }

  /// A window of its own, in every language. It is closed then.
  void bench(BenchWindow& bench, const QString& name) {
    for (const auto& choice : Language::choices()) {
      window_.set_theme(false);
      window_.set_language(choice.code);
      for (int round = 0; round < 12; ++round) QCoreApplication::processEvents(QEventLoop::AllEvents, 20);
      save(bench, QStringLiteral("%1-%2").arg(name, choice.code));
    }
    bench.close();
  }

  /// As it is, without waiting for news.
  void at_once(const QString& name) {
    for (int i = 0; i < 6; ++i)
      QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents | QEventLoop::AllEvents, 20);
    save(window_, name);
  }

 private:
  /// When a few statuses have come in the new language.
  void take(const QString& name) {
    const double from = desk_.session.status().time_s();
    const QDeadlineTimer deadline(20'000);
    for (int round = 0; !deadline.hasExpired(); ++round) {
      QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents | QEventLoop::AllEvents, 20);
      const bool fresh = desk_.demo == nullptr ||
                         (desk_.session.connected() && desk_.session.status().time_s() > from + 0.4);
      if (round >= 12 && fresh && !desk_.path.loading()) break;
    }
    save(window_, name);
  }

  void save(QWidget& widget, const QString& name) {
    const QString path = QStringLiteral("%1/%2.png").arg(folder_, name);
    if (!widget.grab().save(path)) throw std::runtime_error("cannot write " + path.toStdString());
    std::printf("  %s\n", qPrintable(path));
  }

  Desk& desk_;
  MainWindow& window_;
  QString folder_;
};

}  // namespace kinebus::gui
