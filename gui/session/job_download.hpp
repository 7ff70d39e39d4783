#pragma once
// The text of a job that is on the gateway, read page by page into a file of the cache, where it is found
// again by its hash.

#include <QFile>
#include <QObject>
#include <QPointer>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

class Session;

class JobDownload : public QObject {
  Q_OBJECT
 public:
  JobDownload(Session& session, const joblink::Job& job, QObject* parent = nullptr);
  /// finished() or failed() follows.
  void begin();
  /// Where the text of a job with this hash is kept, whether it is there or not.
  static QString cache_path(const std::string& hash);

 signals:
  void progressed(double share);
  void finished(const QString& path);
  void failed(const QString& why);

 private:
  void read_on();

  Session& session_;
  joblink::Job job_;
  QFile file_;
  qint64 offset_bytes_ = 0;
};

}  // namespace kinebus::gui
