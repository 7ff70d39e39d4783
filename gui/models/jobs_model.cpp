#include "gui/models/jobs_model.hpp"

#include <QModelIndex>
#include <QObject>
#include <QString>
#include <QVariant>

#include "gui/models/format.hpp"
#include "gui/session/gateway_words.hpp"
#include "gui/session/job_upload.hpp"
#include "gui/session/session.hpp"

namespace kinebus::gui {

JobsModel::JobsModel(Session& session, QObject* parent) : QAbstractTableModel(parent), session_(session) {
  connect(&session, &Session::jobs_changed, this, &JobsModel::take_jobs);
  connect(&session, &Session::upload_begun, this, &JobsModel::add_upload);
  take_jobs();
}

int JobsModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(uploads_.size()) + jobs_.jobs_size();
}

int JobsModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumns;
}

void JobsModel::take_jobs() {
  beginResetModel();
  jobs_ = session_.jobs();
  std::sort(jobs_.mutable_jobs()->begin(), jobs_.mutable_jobs()->end(),
            [](const auto& a, const auto& b) { return a.stored_unix_s() > b.stored_unix_s(); });
  endResetModel();
}

void JobsModel::add_upload(JobUpload* upload) {
  beginInsertRows({}, 0, 0);
  uploads_.push_front(upload);
  endInsertRows();
  connect(upload, &JobUpload::changed, this, [this, upload] {
    const int row = static_cast<int>(uploads_.indexOf(QPointer<JobUpload>(upload)));
    if (row < 0) return;
    const auto phase = upload->phase();
    if (phase == JobUpload::Phase::kStored || phase == JobUpload::Phase::kStopped) {
      beginRemoveRows({}, row, row);
      uploads_.removeAt(row);
      endRemoveRows();
      upload->deleteLater();
      return;
    }
    emit dataChanged(index(row, 0), index(row, kColumns - 1));
  });
}

const joblink::Job* JobsModel::job_at(int row) const {
  const int i = row - static_cast<int>(uploads_.size());
  return i >= 0 && i < jobs_.jobs_size() ? &jobs_.jobs(i) : nullptr;
}

JobUpload* JobsModel::upload_at(int row) const {
  return row >= 0 && row < uploads_.size() ? uploads_[row].data() : nullptr;
}

int JobsModel::row_of(const QString& job_name) const {
  const std::string name = job_name.toStdString();
  for (int i = 0; i < jobs_.jobs_size(); ++i)
    if (jobs_.jobs(i).name() == name) return i + static_cast<int>(uploads_.size());
  return -1;
}

const joblink::Job* JobsModel::find(const QString& job_name) const {
  const int row = row_of(job_name);
  return row < 0 ? nullptr : job_at(row);
}

QVariant JobsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  switch (section) {
    case kName:
      return tr("Job");
    case kSize:
      return tr("Size");
    case kStored:
      return tr("Uploaded");
    case kCheck:
      return tr("Check");
    case kEstimate:
      return tr("Time");
    case kLastRun:
      return tr("Last run");
    default:
      return {};
  }
}

QVariant JobsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  if (const JobUpload* upload = upload_at(index.row())) {
    switch (role) {
      case Qt::DisplayRole:
        return upload_text(*upload, index.column());
      case Qt::ToolTipRole:
        return upload->error().isEmpty() ? upload->file_path() : upload->error();
      case kIsUpload:
        return true;
      case kUploadFailed:
        return upload->phase() == JobUpload::Phase::kFailed;
      case kProgress:
        return upload->size_bytes() > 0
                   ? static_cast<double>(upload->sent_bytes()) / static_cast<double>(upload->size_bytes())
                   : 0.0;
      default:
        return {};
    }
  }
  const joblink::Job* job = job_at(index.row());
  if (job == nullptr) return {};
  if (role == Qt::DisplayRole) return job_text(*job, index.column());
  if (role == Qt::ToolTipRole && index.column() == kLastRun && job->has_last_run())
    return GatewayWords::said(job->last_run().first_error_said(), job->last_run().first_error());
  return {};
}

QVariant JobsModel::upload_text(const JobUpload& upload, int column) const {
  switch (column) {
    case kName:
      return upload.name();
    case kSize:
      return Format::isolated(Format::bytes(static_cast<double>(upload.size_bytes())));
    case kStored:
      return Format::percent(upload.size_bytes() > 0 ? static_cast<double>(upload.sent_bytes()) /
                                                           static_cast<double>(upload.size_bytes())
                                                     : 0);
    case kCheck:
      switch (upload.phase()) {
        case JobUpload::Phase::kReading:
          return tr("Reading");
        case JobUpload::Phase::kSending:
          return Format::bytes_per_s(upload.bytes_per_s());
        case JobUpload::Phase::kWaiting:
          return tr("Waiting for the gateway");
        case JobUpload::Phase::kFailed:
          return tr("Failed");
        default:
          return {};
      }
    default:
      return {};
  }
}

QVariant JobsModel::job_text(const joblink::Job& job, int column) const {
  switch (column) {
    case kName:
      return QString::fromStdString(job.name());
    case kSize:
      return Format::isolated(Format::bytes(static_cast<double>(job.size_bytes())));
    case kStored:
      return Format::date_time(job.stored_unix_s());
    case kCheck:
      if (!job.has_preflight()) return tr("Not checked");
      if (job.preflight().errors() > 0)
        return tr("%Ln error(s)", nullptr, static_cast<int>(job.preflight().errors()));
      if (job.preflight().warnings() > 0)
        return tr("%Ln warning(s)", nullptr, static_cast<int>(job.preflight().warnings()));
      return tr("Fine");
    case kEstimate:
      if (!job.has_preflight() || !(job.preflight().motion_s() > 0)) return QStringLiteral("–");
      return Format::duration(job.preflight().motion_s() + job.preflight().dwell_s());
    case kLastRun:
      if (!job.has_last_run()) return tr("Never");
      switch (job.last_run().result()) {
        case joblink::JOB_RUNNING:
          return tr("Running");
        case joblink::JOB_COMPLETE:
          return tr("Complete, %1").arg(Format::duration(job.last_run().duration_s()));
        case joblink::JOB_CANCELLED:
          return tr("Cancelled");
        case joblink::JOB_REFUSED:
          return tr("Refused by the check");
        case joblink::JOB_FAILED:
          return tr("Stopped by an alarm");
        case joblink::JOB_INTERRUPTED:
          return tr("Interrupted");
        default:
          return {};
      }
    default:
      return {};
  }
}

void JobsModel::retranslate() {
  emit headerDataChanged(Qt::Horizontal, 0, kColumns - 1);
  if (rowCount() > 0) emit dataChanged(index(0, 0), index(rowCount() - 1, kColumns - 1));
}

}  // namespace kinebus::gui
