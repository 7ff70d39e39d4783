#include "gui/views/table_columns.hpp"

#include <QAbstractItemModel>
#include <QEvent>
#include <QHeaderView>
#include <algorithm>

namespace kinebus::gui {
namespace {

/// Beside the text, so that neighbours stay apart.
constexpr int kAir = 12;

/// Qt keeps both sizes for itself and for those who derive.
class Sizes : public QTableView {
 public:
  static int hint(const QTableView* table, int column) {
    return (table->*(&Sizes::sizeHintForColumn))(column);
  }
};

}  // namespace

TableColumns::TableColumns(QTableView* table, int least) : QObject(table), table_(table), least_(least) {
  table->setHorizontalScrollMode(QAbstractItemView::ScrollPerPixel);
  table->horizontalHeader()->setSectionResizeMode(QHeaderView::Fixed);
  table->horizontalHeader()->setMinimumSectionSize(least);
  table->viewport()->installEventFilter(this);
  connect(table->model(), &QAbstractItemModel::dataChanged, this, &TableColumns::fit);
  connect(table->model(), &QAbstractItemModel::modelReset, this, &TableColumns::fit);
  connect(table->model(), &QAbstractItemModel::headerDataChanged, this, &TableColumns::forget);
}

void TableColumns::forget() {
  needed_.clear();
  fit();
}

void TableColumns::fit() {
  if (!table_->isVisible()) return;
  const QAbstractItemModel& model = *table_->model();
  const int columns = model.columnCount();
  needed_.resize(columns);
  int sum = 0, shown = 0;
  for (int c = 0; c < columns; ++c) {
    if (table_->isColumnHidden(c)) continue;
    const int wanted =
        kAir + std::max(Sizes::hint(table_, c), table_->horizontalHeader()->sectionSizeHint(c));
    needed_[c] = std::max({needed_[c], wanted, least_});
    sum += needed_[c];
    ++shown;
  }
  if (shown == 0) return;
  // Too much for the room: it is scrolled sideways, no value is cut.
  const int room = std::max(table_->viewport()->width(), sum);
  int left = room;
  for (int c = 0, i = 0; c < columns; ++c) {
    if (table_->isColumnHidden(c)) continue;
    ++i;
    const int width = needed_[c] + (room - sum) / shown;
    const int given = i == shown ? left : width;
    left -= given;
    if (table_->columnWidth(c) != given) table_->setColumnWidth(c, given);
  }
}

bool TableColumns::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize || event->type() == QEvent::Show) fit();
  return QObject::eventFilter(watched, event);
}

}  // namespace kinebus::gui
