#pragma once
// What has happened, newest first: alarms and messages.

#include <QAbstractListModel>
#include <QModelIndex>
#include <QVariant>
#include <deque>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

class Session;

class EventsModel : public QAbstractListModel {
  Q_OBJECT
 public:
  enum Role { kTitle = Qt::UserRole, kDetails, kAdvice, kWhen, kIsAlarm, kCode };
  explicit EventsModel(Session& session, QObject* parent = nullptr);
  int rowCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  /// Alarms since the machine was last well; 0: none.
  int open_alarms() const { return open_alarms_; }
  const joblink::Event* newest_alarm() const;
  void retranslate();

 signals:
  void alarm_arrived();
  void open_alarms_changed();

 private:
  void add(const joblink::Event& event, bool live);
  static bool shown(const joblink::Event& event);

  std::deque<joblink::Event> events_;  ///< newest first
  int open_alarms_ = 0;
};

}  // namespace kinebus::gui
