#include "gui/session/job_download.hpp"

#include <QByteArray>
#include <QDir>
#include <QFileInfo>
#include <QIODevice>
#include <QLatin1Char>
#include <QMetaObject>
#include <QStandardPaths>

#include "gui/session/session.hpp"

namespace kinebus::gui {
namespace {
constexpr std::uint32_t kPageBytes = 256 * 1024;
}

QString JobDownload::cache_path(const std::string& hash) {
  const QString folder =
      QStandardPaths::writableLocation(QStandardPaths::CacheLocation) + QStringLiteral("/jobs");
  QDir().mkpath(folder);
  return folder + QLatin1Char('/') + QString::fromLatin1(QByteArray::fromStdString(hash).toHex()) +
         QStringLiteral(".gcode");
}

JobDownload::JobDownload(Session& session, const joblink::Job& job, QObject* parent)
    : QObject(parent),
      session_(session),
      job_(job),
      file_(cache_path(job.hash()) + QStringLiteral(".part")) {}

void JobDownload::begin() {
  const QString done = cache_path(job_.hash());
  if (QFileInfo(done).size() == static_cast<qint64>(job_.size_bytes()) && QFileInfo::exists(done)) {
    QMetaObject::invokeMethod(
        this, [this, done] { emit finished(done); }, Qt::QueuedConnection);
    return;
  }
  if (!file_.open(QIODevice::WriteOnly | QIODevice::Truncate)) {
    const QString why = file_.errorString();
    QMetaObject::invokeMethod(
        this, [this, why] { emit failed(why); }, Qt::QueuedConnection);
    return;
  }
  read_on();
}

void JobDownload::read_on() {
  joblink::ClientMessage request;
  auto& read = *request.mutable_read_job();
  read.set_name(job_.name());
  read.set_offset_bytes(static_cast<std::uint64_t>(offset_bytes_));
  read.set_max_bytes(kPageBytes);
  session_.send(std::move(request), [self = QPointer<JobDownload>(this)](const joblink::Reply& reply) {
    if (self.isNull()) return;
    if (!reply.has_job_text()) {
      emit self->failed(to_words(reply.error()));
      return;
    }
    const std::string& data = reply.job_text().data();
    self->file_.write(data.data(), static_cast<qint64>(data.size()));
    self->offset_bytes_ += static_cast<qint64>(data.size());
    const auto size = static_cast<qint64>(reply.job_text().size_bytes());
    if (!data.empty() && self->offset_bytes_ < size) {
      emit self->progressed(static_cast<double>(self->offset_bytes_) / static_cast<double>(size));
      self->read_on();
      return;
    }
    self->file_.close();
    const QString done = cache_path(self->job_.hash());
    QFile::remove(done);
    self->file_.rename(done);
    emit self->finished(done);
  });
}

}  // namespace kinebus::gui
