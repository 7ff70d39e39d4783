#include "gui/views/job_delegate.hpp"

#include <QRectF>

#include "gui/models/jobs_model.hpp"

namespace kinebus::gui {

void JobDelegate::paint(QPainter* painter, const QStyleOptionViewItem& option,
                        const QModelIndex& index) const {
  QStyledItemDelegate::paint(painter, option, index);
  if (!index.data(JobsModel::kIsUpload).toBool() || index.column() != JobsModel::kStored) return;
  const double share = index.data(JobsModel::kProgress).toDouble();
  const QRectF groove(option.rect.left() + 6, option.rect.bottom() - 6, option.rect.width() - 12, 3);
  painter->setRenderHint(QPainter::Antialiasing);
  painter->setPen(Qt::NoPen);
  painter->setBrush(theme_.colours().border);
  painter->drawRoundedRect(groove, 1.5, 1.5);
  QRectF done = groove;
  if (option.direction == Qt::RightToLeft)
    done.setLeft(groove.right() - groove.width() * share);
  else
    done.setWidth(groove.width() * share);
  painter->setBrush(index.data(JobsModel::kUploadFailed).toBool() ? theme_.colours().danger
                                                                  : theme_.colours().accent);
  painter->drawRoundedRect(done, 1.5, 1.5);
}

}  // namespace kinebus::gui
