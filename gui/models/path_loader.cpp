#include "gui/models/path_loader.hpp"

#include <QByteArray>
#include <QCoreApplication>
#include <QFile>
#include <QIODevice>
#include <QMetaObject>
#include <QPointer>
#include <QThreadPool>

#include "gui/scene/path_reader.hpp"

namespace kinebus::gui {
namespace {

constexpr qint64 kPartBytes = 1 << 20;

struct Outcome {
  std::shared_ptr<const ScenePath> scene;
  QString error;
};

Outcome load_file(const QString& path, const std::optional<MachineModel>& model,
                  const gcode::Options& machine, const std::atomic<bool>& cancelled,
                  const std::function<void(double)>& progress) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly)) return {nullptr, file.errorString()};
  PathReader reader({.machine = machine});
  const auto total = static_cast<double>(std::max<qint64>(1, file.size()));
  double told = 0;
  while (!file.atEnd()) {
    if (cancelled) return {};
    const QByteArray part = file.read(kPartBytes);
    if (part.isEmpty()) return {nullptr, file.errorString()};
    reader.add({part.constData(), static_cast<std::size_t>(part.size())});
    if (const double share = static_cast<double>(file.pos()) / total * 0.6; share > told + 0.05)
      progress(told = share);
  }
  auto scene = std::make_shared<ScenePath>();
  scene->path = reader.finish();
  const auto stop = [&] { return cancelled.load(); };
  progress(0.7);
  scene->levels = make_path_levels(scene->path, stop);
  progress(0.85);
  scene->shades = shade_path(scene->path, model, stop);
  if (cancelled) return {};
  return {std::move(scene), {}};
}

}  // namespace

PathLoader::PathLoader(QObject* parent) : QObject(parent) {}

PathLoader::~PathLoader() {
  cancel();
}

void PathLoader::cancel() {
  if (cancelled_ != nullptr) *cancelled_ = true;
  cancelled_.reset();
}

void PathLoader::load(const QString& file_path, const std::optional<MachineModel>& model,
                      const gcode::Options& machine) {
  cancel();
  cancelled_ = std::make_shared<std::atomic<bool>>(false);
  // The thread never touches this object: it posts to the application, which finds out whether it is still
  // there.
  QThreadPool::globalInstance()->start(
      [self = QPointer<PathLoader>(this), cancelled = cancelled_, file_path, model, machine] {
        const auto post = [&](auto&& news) {
          QMetaObject::invokeMethod(
              qApp,
              [self, cancelled, news = std::forward<decltype(news)>(news)] {
                if (!*cancelled && !self.isNull()) news(*self);
              },
              Qt::QueuedConnection);
        };
        Outcome outcome = load_file(file_path, model, machine, *cancelled, [&](double share) {
          post([share](PathLoader& loader) { emit loader.progressed(share); });
        });
        post([outcome = std::move(outcome)](PathLoader& loader) {
          if (outcome.scene != nullptr)
            emit loader.loaded(outcome.scene);
          else
            emit loader.failed(outcome.error);
        });
      });
}

}  // namespace kinebus::gui
