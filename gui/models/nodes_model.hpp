#pragma once
// The nodes on the bus: alive, in time, and with how much motion in their queues.

#include <QAbstractTableModel>
#include <QModelIndex>
#include <QVariant>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

class Session;

class NodesModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  enum Column { kNode, kState, kSync, kQueue, kInputs, kSent, kEmergencies, kColumns };
  enum Role { kShare = Qt::UserRole, kWell };
  explicit NodesModel(Session& session, QObject* parent = nullptr);
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  QString state_of(const joblink::NodeStatus& node) const;
  Session& session_;
  int rows_ = 0;
};

}  // namespace kinebus::gui
