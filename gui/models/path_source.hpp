#pragma once
// Which job's path is shown: the job that runs, or the one the user has chosen. Finds its text here (the file
// that was just uploaded), in the cache, or on the gateway, and has it loaded.

#include <QHash>
#include <QObject>
#include <QPointer>
#include <optional>

#include "gui/models/path_loader.hpp"

namespace kinebus::gui {

class JobDownload;
class Session;

class PathSource : public QObject {
  Q_OBJECT
 public:
  explicit PathSource(Session& session, QObject* parent = nullptr);
  /// A job on the gateway, by name.
  void show_job(const QString& name);
  /// A file of this computer, before it is uploaded.
  void show_file(const QString& path);
  void clear();
  const QString& name() const { return name_; }
  const std::shared_ptr<const ScenePath>& scene() const { return scene_; }
  bool loading() const { return loading_; }
  double progress() const { return progress_; }
  const QString& error() const { return error_; }
  /// Text of the job that is shown, as far as it is on this computer; empty: not yet.
  const QString& file_path() const { return file_path_; }

 signals:
  void changed();
  /// A job is to be shown, by the user's choice or because it runs.
  void chosen();

 private:
  void load(const QString& path);
  void follow_status();
  void follow_offsets();

  Session& session_;
  PathLoader loader_;
  QPointer<JobDownload> download_;
  QHash<QString, QString> uploaded_files_;  ///< job name to the file it came from
  /// Work zeros of the machine, as far as the gateway has told them, and those that the path was read with.
  gcode::WorkOffsets offsets_{}, read_with_{};
  QString name_, file_path_, error_, running_;
  std::shared_ptr<const ScenePath> scene_;
  bool loading_ = false;
  double progress_ = 0;
};

}  // namespace kinebus::gui
