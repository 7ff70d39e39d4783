#pragma once
// One file on its way to the gateway: hashed in a thread of the pool, then sent by the client. Survives
// broken links.

#include <QByteArray>
#include <QElapsedTimer>
#include <QObject>

#include "protocol/joblink/client.hpp"

namespace kinebus::gui {

class Session;

class JobUpload : public QObject {
  Q_OBJECT
 public:
  enum class Phase { kReading, kSending, kWaiting, kStored, kFailed, kStopped };
  Q_ENUM(Phase)

  JobUpload(Session& session, const QString& file_path);
  void begin();
  void stop();

  Phase phase() const { return phase_; }
  const QString& name() const { return name_; }
  const QString& file_path() const { return file_path_; }
  qint64 sent_bytes() const { return sent_bytes_; }
  qint64 size_bytes() const { return size_bytes_; }
  double bytes_per_s() const;  ///< over the whole upload so far
  const QString& error() const { return error_; }
  bool ended() const {
    return phase_ == Phase::kStored || phase_ == Phase::kFailed || phase_ == Phase::kStopped;
  }

 signals:
  void changed();

 private:
  void send(const QByteArray& hash);
  void on_news(const joblink::UploadNews& news);
  void end(Phase phase, const QString& error);

  Session& session_;
  QString file_path_, name_, error_;
  Phase phase_ = Phase::kReading;
  qint64 size_bytes_ = 0, sent_bytes_ = 0, resumed_at_bytes_ = -1;
  joblink::UploadId id_ = 0;
  QElapsedTimer clock_;
};

}  // namespace kinebus::gui
