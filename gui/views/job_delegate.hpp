#pragma once
// A row of the jobs' table: an upload has its progress drawn under it.

#include <QModelIndex>
#include <QPainter>
#include <QStyleOptionViewItem>
#include <QStyledItemDelegate>

#include "gui/views/theme.hpp"

namespace kinebus::gui {

class JobDelegate : public QStyledItemDelegate {
 public:
  JobDelegate(const Theme& theme, QObject* parent) : QStyledItemDelegate(parent), theme_(theme) {}
  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override;

 private:
  const Theme& theme_;
};

}  // namespace kinebus::gui
