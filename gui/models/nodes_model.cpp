#include "gui/models/nodes_model.hpp"

#include <QChar>
#include <QLocale>
#include <QModelIndex>
#include <QObject>
#include <QString>
#include <QVariant>

#include "gui/models/format.hpp"
#include "gui/session/session.hpp"

namespace kinebus::gui {
namespace {

bool is_figure(int column) {
  return column == NodesModel::kSync || column == NodesModel::kSent || column == NodesModel::kEmergencies;
}

/// A node without axes, of heat for one, has neither queue nor path time.
bool keeps_path_time(const joblink::NodeStatus& node) {
  return node.axes_size() > 0;
}

}  // namespace

NodesModel::NodesModel(Session& session, QObject* parent) : QAbstractTableModel(parent), session_(session) {
  connect(&session, &Session::status_changed, this, [this] {
    const int rows = session_.status().nodes_size();
    if (rows != rows_) {
      beginResetModel();
      rows_ = rows;
      endResetModel();
    } else if (rows_ > 0) {
      emit dataChanged(index(0, 0), index(rows_ - 1, kColumns - 1));
    }
  });
}

int NodesModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : std::min(rows_, session_.status().nodes_size());
}
int NodesModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumns;
}

QVariant NodesModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal) return {};
  if (role == Qt::TextAlignmentRole && is_figure(section))
    return QVariant(Qt::AlignTrailing | Qt::AlignVCenter);
  if (role != Qt::DisplayRole) return {};
  switch (section) {
    case kNode:
      return tr("Node");
    case kState:
      return tr("State");
    case kSync:
      return tr("Clock error");
    case kQueue:
      return tr("Queue");
    case kInputs:
      return tr("Inputs");
    case kSent:
      return tr("Segments sent");
    case kEmergencies:
      return tr("Faults");
    default:
      return {};
  }
}

QString NodesModel::state_of(const joblink::NodeStatus& node) const {
  if (!node.present()) return tr("Not there");
  if (node.stopped()) return tr("Stopped");
  switch (node.nmt_state()) {
    case 0:
      return tr("Starting");
    case 4:
      return tr("Idle");
    case 5:
      return node.synchronised() || !keeps_path_time(node) ? tr("Operational")
                                                           : tr("Operational, not in time");
    case 127:
      return tr("Waiting");
    default:
      return QString::number(node.nmt_state());
  }
}

QVariant NodesModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= session_.status().nodes_size()) return {};
  const joblink::NodeStatus& node = session_.status().nodes(index.row());
  if (role == kWell) return node.present() && !node.stopped() && node.nmt_state() == 5;
  if (role == kShare)
    return node.queue_capacity() > 0 ? static_cast<double>(node.queue_records()) / node.queue_capacity()
                                     : -1.0;
  if (role == Qt::TextAlignmentRole && is_figure(index.column()))
    return QVariant(Qt::AlignTrailing | Qt::AlignVCenter);
  if (role != Qt::DisplayRole) return {};
  switch (index.column()) {
    case kNode:
      return Format::number(node.id(), 0);
    case kState:
      return state_of(node);
    case kSync:
      if (!keeps_path_time(node)) return {};
      return Format::isolated(tr("%1 µs").arg(Format::number(node.sync_error_s() * 1e6, 1)));
    case kQueue:
      if (!keeps_path_time(node)) return {};
      return Format::isolated(QStringLiteral("%1 / %2").arg(Format::number(node.queue_records(), 0),
                                                            Format::number(node.queue_capacity(), 0)));
    case kInputs: {
      QString dots;
      for (unsigned i = 0; i < 7; ++i) dots += (node.inputs() >> i & 1u) != 0 ? QChar(0x25CF) : QChar(0x25CB);
      return Format::isolated(dots);
    }
    case kSent:
      return QLocale().toString(static_cast<qulonglong>(node.records_sent()));
    case kEmergencies:
      return QLocale().toString(node.emergencies());
    default:
      return {};
  }
}

}  // namespace kinebus::gui
