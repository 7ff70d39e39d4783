#pragma once
// The jobs: those on the gateway, and above them those on their way to it.

#include <QAbstractTableModel>
#include <QModelIndex>
#include <QPointer>
#include <QVariant>
#include <QVector>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

class JobUpload;
class Session;

class JobsModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  enum Column { kName, kSize, kStored, kCheck, kEstimate, kLastRun, kColumns };
  enum Role { kProgress = Qt::UserRole, kIsUpload, kUploadFailed, kUploadText };

  explicit JobsModel(Session& session, QObject* parent = nullptr);
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

  /// nullptr: the row is an upload.
  const joblink::Job* job_at(int row) const;
  JobUpload* upload_at(int row) const;  ///< nullptr: the row is a job
  int row_of(const QString& job_name) const;
  const joblink::Job* find(const QString& job_name) const;
  void retranslate();

 private:
  void add_upload(JobUpload* upload);
  void take_jobs();
  QVariant job_text(const joblink::Job& job, int column) const;
  QVariant upload_text(const JobUpload& upload, int column) const;

  Session& session_;
  QVector<QPointer<JobUpload>> uploads_;  ///< those that have not ended well
  joblink::JobList jobs_;
};

}  // namespace kinebus::gui
