#pragma once
// Makes a job's picture of its file in a thread of the pool. A new load cancels the one before.

#include <QObject>
#include <atomic>
#include <memory>
#include <optional>

#include "gateway/gcode/interpreter.hpp"
#include "gui/scene/gl_path.hpp"

namespace kinebus::gui {

class PathLoader : public QObject {
  Q_OBJECT
 public:
  explicit PathLoader(QObject* parent = nullptr);
  ~PathLoader() override;
  /// `machine`: what is known of the machine that will run the job.
  void load(const QString& file_path, const std::optional<MachineModel>& model,
            const gcode::Options& machine);
  void cancel();

 signals:
  void progressed(double share);
  void loaded(std::shared_ptr<const kinebus::gui::ScenePath> scene);
  void failed(const QString& why);

 private:
  std::shared_ptr<std::atomic<bool>> cancelled_;
};

}  // namespace kinebus::gui
