#include "gui/models/path_source.hpp"

#include <QFileInfo>

#include "gui/models/machine_picture.hpp"
#include "gui/session/job_download.hpp"
#include "gui/session/job_upload.hpp"
#include "gui/session/session.hpp"

namespace kinebus::gui {

PathSource::PathSource(Session& session, QObject* parent)
    : QObject(parent), session_(session), loader_(this) {
  connect(&loader_, &PathLoader::progressed, this, [this](double share) {
    progress_ = share;
    emit changed();
  });
  connect(&loader_, &PathLoader::loaded, this, [this](const std::shared_ptr<const ScenePath>& scene) {
    scene_ = scene;
    loading_ = false;
    emit changed();
  });
  connect(&loader_, &PathLoader::failed, this, [this](const QString& why) {
    loading_ = false;
    error_ = why;
    emit changed();
  });
  connect(&session, &Session::status_changed, this, &PathSource::follow_status);
  connect(&session, &Session::upload_begun, this, [this](JobUpload* upload) {
    connect(upload, &JobUpload::changed, this, [this, upload] {
      if (upload->phase() == JobUpload::Phase::kStored) uploaded_files_[upload->name()] = upload->file_path();
    });
  });
}

void PathSource::follow_offsets() {
  const joblink::Status& status = session_.status();
  const std::size_t system = status.work_system();
  if (system < 1 || system > offsets_.size()) return;
  offsets_[system - 1] = to_pose(status.work_offset());
  // A job that runs keeps the zeros that it began with.
  if (offsets_ == read_with_ || file_path_.isEmpty() || loading_ || !status.job().empty()) return;
  load(file_path_);
}

void PathSource::follow_status() {
  follow_offsets();
  const QString job = QString::fromStdString(session_.status().job());
  if (job == running_) return;
  // Wait until the list of jobs has it: the hash tells whether it is in the cache.
  const auto& jobs = session_.jobs().jobs();
  const bool known = std::any_of(jobs.begin(), jobs.end(),
                                 [&](const auto& j) { return j.name() == session_.status().job(); });
  if (!job.isEmpty() && !known) return;
  running_ = job;
  if (!job.isEmpty()) show_job(job);
}

void PathSource::clear() {
  loader_.cancel();
  delete download_;
  name_.clear();
  file_path_.clear();
  error_.clear();
  running_.clear();
  offsets_ = {};
  scene_ = nullptr;
  loading_ = false;
  emit changed();
}

void PathSource::show_file(const QString& path) {
  emit chosen();
  name_ = QFileInfo(path).fileName();
  load(path);
}

void PathSource::load(const QString& path) {
  file_path_ = path;
  error_.clear();
  loading_ = true;
  progress_ = 0;
  read_with_ = offsets_;
  gcode::Options machine = reading_options(session_.machine());
  machine.work_offsets = offsets_;
  loader_.load(path, model_of(session_.machine()), machine);
  emit changed();
}

void PathSource::show_job(const QString& name) {
  emit chosen();
  const joblink::Job* job = nullptr;
  for (const auto& j : session_.jobs().jobs())
    if (j.name() == name.toStdString()) job = &j;
  if (job == nullptr || (name == name_ && (loading_ || scene_ != nullptr))) return;
  name_ = name;
  scene_ = nullptr;
  error_.clear();
  delete download_;
  const QFileInfo local(uploaded_files_.value(name));
  if (local.exists() && local.size() == static_cast<qint64>(job->size_bytes())) return load(local.filePath());
  loading_ = true;
  progress_ = 0;
  file_path_.clear();
  loader_.cancel();
  download_ = new JobDownload(session_, *job, this);
  connect(download_, &JobDownload::finished, this, &PathSource::load);
  connect(download_, &JobDownload::failed, this, [this](const QString& why) {
    loading_ = false;
    error_ = why;
    emit changed();
  });
  download_->begin();
  emit changed();
}

}  // namespace kinebus::gui
