#include "gui/session/job_upload.hpp"

#include <QByteArray>
#include <QCoreApplication>
#include <QFile>
#include <QFileInfo>
#include <QIODevice>
#include <QMetaObject>
#include <QPointer>
#include <QThreadPool>

#include "gui/session/session.hpp"
#include "protocol/joblink/job_hash.hpp"

namespace kinebus::gui {
namespace {

constexpr qint64 kReadBytes = 1 << 20;

class FileSource : public joblink::UploadSource {
 public:
  explicit FileSource(const QString& path) : file_(path) { opened_ = file_.open(QIODevice::ReadOnly); }
  std::size_t read(std::uint64_t offset_bytes, std::span<char> buffer) override {
    if (!opened_ || !file_.seek(static_cast<qint64>(offset_bytes))) return 0;
    return static_cast<std::size_t>(
        std::max<qint64>(0, file_.read(buffer.data(), static_cast<qint64>(buffer.size()))));
  }

 private:
  QFile file_;
  bool opened_ = false;
};

/// Empty: cannot be read.
QByteArray hash_file(const QString& path) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly)) return {};
  joblink::JobHash hash;
  while (!file.atEnd()) {
    const QByteArray part = file.read(kReadBytes);
    if (part.isEmpty()) return {};
    hash.add({part.constData(), static_cast<std::size_t>(part.size())});
  }
  return QByteArray::fromStdString(hash.finish());
}

}  // namespace

JobUpload::JobUpload(Session& session, const QString& file_path)
    : QObject(&session), session_(session), file_path_(file_path), name_(QFileInfo(file_path).fileName()) {
  size_bytes_ = QFileInfo(file_path).size();
  connect(&session, &Session::upload_news, this, &JobUpload::on_news);
}

void JobUpload::begin() {
  clock_.start();
  QThreadPool::globalInstance()->start([self = QPointer<JobUpload>(this), path = file_path_] {
    const QByteArray hash = hash_file(path);
    QMetaObject::invokeMethod(
        qApp,
        [self, hash] {
          if (!self.isNull()) self->send(hash);
        },
        Qt::QueuedConnection);
  });
}

void JobUpload::send(const QByteArray& hash) {
  if (ended()) return;
  if (hash.isEmpty()) return end(Phase::kFailed, tr("%1 cannot be read").arg(file_path_));
  phase_ = Phase::kSending;
  clock_.start();
  joblink::UploadRequest request{.name = name_.toStdString(),
                                 .size_bytes = static_cast<std::uint64_t>(size_bytes_),
                                 .hash = hash.toStdString()};
  id_ = session_.client().upload(std::move(request), std::make_unique<FileSource>(file_path_));
  emit changed();
  session_.pump();
}

void JobUpload::stop() {
  if (ended()) return;
  phase_ = Phase::kStopped;
  if (id_ != 0) session_.client().abort_upload(id_, true);
  session_.pump();
  emit changed();
}

void JobUpload::on_news(const joblink::UploadNews& news) {
  if (id_ == 0 || news.upload != id_ || ended()) return;
  sent_bytes_ = static_cast<qint64>(news.received_bytes);
  // What the gateway had already is not counted in the speed.
  if (resumed_at_bytes_ < 0) {
    resumed_at_bytes_ = sent_bytes_;
    clock_.start();
  }
  switch (news.phase) {
    case joblink::UploadNews::Phase::kSending:
      phase_ = Phase::kSending;
      break;
    case joblink::UploadNews::Phase::kWaiting:
      phase_ = Phase::kWaiting;
      break;
    case joblink::UploadNews::Phase::kStored:
      sent_bytes_ = size_bytes_;
      session_.list_jobs();
      return end(Phase::kStored, {});
    case joblink::UploadNews::Phase::kFailed:
      return end(Phase::kFailed, to_words(news.error));
  }
  emit changed();
}

void JobUpload::end(Phase phase, const QString& error) {
  phase_ = phase;
  error_ = error;
  emit changed();
}

double JobUpload::bytes_per_s() const {
  const double seconds = static_cast<double>(clock_.nsecsElapsed()) * 1e-9;
  const qint64 from = std::max<qint64>(0, resumed_at_bytes_);
  return seconds > 0.05 ? static_cast<double>(sent_bytes_ - from) / seconds : 0;
}

}  // namespace kinebus::gui
