#include "gui/models/events_model.hpp"

#include <QModelIndex>
#include <QObject>
#include <QString>
#include <QStringList>
#include <QVariant>

#include "gui/models/alarm_words.hpp"
#include "gui/models/format.hpp"
#include "gui/models/state_words.hpp"
#include "gui/session/gateway_words.hpp"
#include "gui/session/session.hpp"

namespace kinebus::gui {
namespace {
constexpr std::size_t kMaxEvents = 1000;
}

EventsModel::EventsModel(Session& session, QObject* parent) : QAbstractListModel(parent) {
  connect(&session, &Session::event_arrived, this, [this](const joblink::Event& event) { add(event, true); });
  connect(&session, &Session::event_history, this, [this](const joblink::EventList& list) {
    beginResetModel();
    events_.clear();
    endResetModel();
    for (const auto& event : list.events()) add(event, false);
  });
  connect(&session, &Session::status_changed, this, [this, &session] {
    const auto state = session.status().state();
    if (open_alarms_ == 0 || state == joblink::STATE_ALARM || state == joblink::STATE_STOPPED ||
        state == joblink::STATE_STOPPING)
      return;
    open_alarms_ = 0;
    emit open_alarms_changed();
  });
}

bool EventsModel::shown(const joblink::Event& event) {
  switch (event.kind()) {
    case joblink::EVENT_ALARM:
    case joblink::EVENT_MESSAGE:
    case joblink::EVENT_PROBLEM:
    case joblink::EVENT_FINISHED:
    case joblink::EVENT_CONTROL:
      return true;
    default:
      return false;
  }
}

void EventsModel::add(const joblink::Event& event, bool live) {
  if (!shown(event)) return;
  // A connection that came back tells its history again.
  if (event.id() != 0 && !events_.empty() && event.id() <= events_.front().id()) return;
  beginInsertRows({}, 0, 0);
  events_.push_front(event);
  endInsertRows();
  if (events_.size() > kMaxEvents) {
    const int last = static_cast<int>(events_.size()) - 1;
    beginRemoveRows({}, last, last);
    events_.pop_back();
    endRemoveRows();
  }
  if (live && event.kind() == joblink::EVENT_ALARM) {
    ++open_alarms_;
    emit open_alarms_changed();
    emit alarm_arrived();
  }
}

const joblink::Event* EventsModel::newest_alarm() const {
  for (const auto& event : events_)
    if (event.kind() == joblink::EVENT_ALARM) return &event;
  return nullptr;
}

int EventsModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(events_.size());
}

QVariant EventsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const joblink::Event& e = events_[static_cast<std::size_t>(index.row())];
  const bool alarm = e.kind() == joblink::EVENT_ALARM;
  const QString words = GatewayWords::said(e.said(), e.words());
  switch (role) {
    case kIsAlarm:
      return alarm;
    case kCode:
      return e.code();
    case kWhen:
      return Format::date_time(e.unix_s());
    case Qt::DisplayRole:
    case kTitle:
      if (alarm && e.code() != 0) return AlarmWords::title(e.code());
      switch (e.kind()) {
        case joblink::EVENT_FINISHED:
          return tr("Done");
        case joblink::EVENT_PROBLEM:
          return tr("The check of the job found a problem");
        case joblink::EVENT_CONTROL:
          return tr("Control of the machine");
        default:
          return tr("Message");
      }
    case kDetails: {
      QStringList parts;
      if (e.node() != 0) parts << tr("node %1").arg(e.node());
      if (e.line() != 0) parts << tr("line %1").arg(e.line());
      const QString place = parts.join(QStringLiteral(", "));
      return place.isEmpty() ? words : place + QStringLiteral(" · ") + words;
    }
    case kAdvice: {
      if (!alarm) return QString();
      const QString said = GatewayWords::said(e.advice_said(), e.advice());
      return AlarmWords::sentence(said.isEmpty() && e.code() != 0 ? AlarmWords::advice(e.code()) : said);
    }
    default:
      return {};
  }
}

void EventsModel::retranslate() {
  if (!events_.empty()) emit dataChanged(index(0, 0), index(rowCount() - 1, 0));
}

}  // namespace kinebus::gui
