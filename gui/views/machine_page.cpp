#include "gui/views/machine_page.hpp"

#include <QAbstractItemModel>
#include <QAbstractItemView>
#include <QColor>
#include <QGridLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLocale>
#include <QModelIndex>
#include <QPainter>
#include <QPointF>
#include <QRectF>
#include <QScrollArea>
#include <QSize>
#include <QStyleOptionViewItem>
#include <QStyledItemDelegate>
#include <QTableView>
#include <QVBoxLayout>
#include <QWidget>

#include "gui/models/format.hpp"
#include "gui/views/heat_panel.hpp"
#include "gui/views/heat_plot.hpp"
#include "gui/views/machine_file_editor.hpp"
#include "gui/views/motors_panel.hpp"
#include "gui/views/plot_widget.hpp"
#include "gui/views/table_columns.hpp"

namespace kinebus::gui {
namespace {

/// A share of a whole behind the text: travel, queue.
class ShareDelegate : public QStyledItemDelegate {
 public:
  ShareDelegate(const Theme& theme, int role, QObject* parent)
      : QStyledItemDelegate(parent), theme_(theme), role_(role) {}
  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    constexpr int kGroove = 80;
    return QStyledItemDelegate::sizeHint(option, index).expandedTo({kGroove, 0});
  }
  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    QStyledItemDelegate::paint(painter, option, index);
    const double share = index.data(role_).toDouble();
    if (share < 0) return;
    const bool text = !index.data(Qt::DisplayRole).toString().isEmpty();
    const QRectF groove(option.rect.left() + 8,
                        text ? option.rect.bottom() - 6 : option.rect.center().y() - 1.5,
                        option.rect.width() - 16, 4);
    painter->setRenderHint(QPainter::Antialiasing);
    painter->setPen(Qt::NoPen);
    painter->setBrush(theme_.colours().border);
    painter->drawRoundedRect(groove, 2, 2);
    painter->setBrush(theme_.colours().accent);
    if (text)
      painter->drawRoundedRect(
          QRectF(groove.left(), groove.top(), groove.width() * std::clamp(share, 0.0, 1.0), groove.height()),
          2, 2);
    else
      painter->drawRoundedRect(
          QRectF(groove.left() + (groove.width() - 8) * std::clamp(share, 0.0, 1.0), groove.top() - 4, 8, 12),
          3, 3);
  }

 private:
  const Theme& theme_;
  int role_;
};

/// A coloured dot before the text.
class DotDelegate : public QStyledItemDelegate {
 public:
  using Colour = std::function<QColor(const QModelIndex&)>;
  DotDelegate(Colour colour, QObject* parent) : QStyledItemDelegate(parent), colour_(std::move(colour)) {}
  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    return QStyledItemDelegate::sizeHint(option, index) + QSize(kDotRoom, 0);
  }
  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    const QColor colour = colour_(index);
    QStyleOptionViewItem shifted = option;
    const bool mirrored = option.direction == Qt::RightToLeft;
    if (colour.isValid())
      mirrored ? shifted.rect.adjust(0, 0, -kDotRoom, 0) : shifted.rect.adjust(kDotRoom, 0, 0, 0);
    QStyledItemDelegate::paint(painter, shifted, index);
    if (!colour.isValid()) return;
    painter->setRenderHint(QPainter::Antialiasing);
    painter->setPen(Qt::NoPen);
    painter->setBrush(colour);
    painter->drawEllipse(QPointF(mirrored ? option.rect.right() - 14 : option.rect.left() + 14,
                                 option.rect.center().y() + 0.5),
                         4.5, 4.5);
  }

 private:
  static constexpr int kDotRoom = 16;
  Colour colour_;
};

QTableView* make_table(QAbstractItemModel* model, QWidget* parent, int rows) {
  auto* table = new QTableView(parent);
  table->setModel(model);
  table->setSelectionMode(QAbstractItemView::NoSelection);
  table->setFocusPolicy(Qt::TabFocus);
  table->setTabKeyNavigation(false);
  table->setShowGrid(false);
  table->setAlternatingRowColors(true);
  table->verticalHeader()->hide();
  table->verticalHeader()->setDefaultSectionSize(32);
  table->horizontalHeader()->setHighlightSections(false);
  table->horizontalHeader()->setDefaultAlignment(Qt::AlignLeading | Qt::AlignVCenter);
  table->setMinimumHeight(38 + 32 * rows);
  new TableColumns(table);
  return table;
}

}  // namespace

MachinePage::MachinePage(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(14, 6, 14, 12);
  tabs_ = new QTabWidget(this);
  tabs_->setDocumentMode(true);
  editor_ = new MachineFileEditor(desk_, this);
  tabs_->addTab(make_live(), {});
  tabs_->addTab(make_numbers(), {});
  tabs_->addTab(editor_, {});
  tabs_->addTab(new MotorsPanel(desk_, this), {});
  heat_ = new HeatPanel(desk_, this);
  tabs_->addTab(heat_, {});
  column->addWidget(tabs_);
  connect(tabs_, &QTabWidget::currentChanged, this, [this](int tab) {
    if (tabs_->widget(tab) == editor_) editor_->read_if_empty();
  });
  connect(&desk_.session, &Session::status_changed, this, &MachinePage::take_status);
  connect(&desk_.session, &Session::machine_changed, this, &MachinePage::take_status);
  says([this] {
    tabs_->setAccessibleName(tr("Machine"));
    tabs_->setTabText(0, tr("Axes and nodes"));
    tabs_->setTabText(1, tr("Bus and time"));
    tabs_->setTabText(2, tr("Machine file"));
    tabs_->setTabText(3, tr("Motors"));
    tabs_->setTabText(4, tr("Heaters"));
    take_status();
  });
}

QWidget* MachinePage::make_live() {
  auto* body = new QWidget;
  auto* column = new QVBoxLayout(body);
  column->setContentsMargins(0, 10, 0, 0);
  column->setSpacing(10);
  summary_ = make_label("muted", body);
  column->addWidget(summary_);
  auto* axes = make_table(&desk_.axes, body, 6);
  axes->setItemDelegateForColumn(AxesModel::kTravel, new ShareDelegate(desk_.theme, AxesModel::kShare, axes));
  axes->setItemDelegateForColumn(AxesModel::kDrive, new DotDelegate(
                                                        [this](const QModelIndex& i) {
                                                          if (i.data(AxesModel::kFault).toBool())
                                                            return desk_.theme.colours().danger;
                                                          return i.data().toString() == QStringLiteral("–")
                                                                     ? QColor()
                                                                     : desk_.theme.colours().good;
                                                        },
                                                        axes));
  axes->setItemDelegateForColumn(AxesModel::kSwitch, new DotDelegate(
                                                         [this](const QModelIndex& i) {
                                                           if (i.data().toString() == QStringLiteral("–"))
                                                             return QColor();
                                                           return i.data(AxesModel::kSwitchOn).toBool()
                                                                      ? desk_.theme.colours().waiting
                                                                      : desk_.theme.colours().border;
                                                         },
                                                         axes));
  auto* nodes = make_table(&desk_.nodes, body, 3);
  nodes->setItemDelegateForColumn(NodesModel::kQueue,
                                  new ShareDelegate(desk_.theme, NodesModel::kShare, nodes));
  nodes->setItemDelegateForColumn(NodesModel::kState, new DotDelegate(
                                                          [this](const QModelIndex& i) {
                                                            return i.data(NodesModel::kWell).toBool()
                                                                       ? desk_.theme.colours().good
                                                                       : desk_.theme.colours().waiting;
                                                          },
                                                          nodes));
  for (const int other : {AxesModel::kCounts, AxesModel::kRun, AxesModel::kHold, AxesModel::kStage})
    axes->setColumnHidden(other, true);
  axes_ = axes;
  column->addWidget(axes, 2);
  column->addWidget(nodes, 1);
  says([this, axes, nodes] {
    axes->setAccessibleName(tr("Axes"));
    nodes->setAccessibleName(tr("Nodes"));
    emit desk_.axes.headerDataChanged(Qt::Horizontal, 0, AxesModel::kColumns - 1);
    emit desk_.nodes.headerDataChanged(Qt::Horizontal, 0, NodesModel::kColumns - 1);
  });
  return body;
}

QWidget* MachinePage::make_numbers() {
  auto* body = new QWidget;
  auto* grid = new QGridLayout(body);
  grid->setContentsMargins(0, 12, 0, 0);
  grid->setSpacing(10);
  const auto plot = [&](StatusHistory::Series series, double full, PlotWidget::Words words, int row,
                        int column, auto title) {
    auto* widget = new PlotWidget(desk_.history, desk_.theme, series, full, std::move(words), body);
    grid->addWidget(widget, row, column);
    says([widget, title] { widget->set_title(title()); });
  };
  const auto percent = [](double v) { return Format::percent(v, 1); };
  plot(StatusHistory::kBusLoad, 0.5, percent, 0, 0, [] { return tr("Bus load"); });
  plot(
      StatusHistory::kSyncError_us, 20,
      [](double v) { return Format::isolated(tr("%1 µs").arg(Format::number(v, 1))); }, 0, 1,
      [] { return tr("Largest clock error"); });
  plot(StatusHistory::kQueue, 1, percent, 1, 0, [] { return tr("Emptiest queue"); });
  plot(StatusHistory::kRate, 1, percent, 1, 1, [] { return tr("Path rate"); });
  grid->addWidget(new HeatPlot(desk_.heat, desk_.theme, body), 2, 0, 1, 2);
  auto* card = new Card(body);
  auto* counters = new QGridLayout;
  counters->setHorizontalSpacing(14);
  counters->setVerticalSpacing(4);
  int i = 0;
  const auto counter = [&](auto title, auto value) {
    auto* name = make_label("muted", card);
    auto* number = new QLabel(card);
    counters->addWidget(name, i / 3, i % 3 * 2);
    counters->addWidget(number, i / 3, i % 3 * 2 + 1);
    counters->setColumnStretch(i % 3 * 2 + 1, 1);
    numbers_.push_back({number, [value, this] {
                          return QLocale().toString(
                              static_cast<qulonglong>(value(desk_.session.status().counters())));
                        }});
    says([name, number, title] {
      name->setText(title());
      align_trailing(*number);
    });
    ++i;
  };
  using C = joblink::Counters;
  counter([] { return tr("Frames sent"); }, [](const C& c) { return c.frames_sent(); });
  counter([] { return tr("Frames received"); }, [](const C& c) { return c.frames_received(); });
  counter([] { return tr("Segments sent"); }, [](const C& c) { return c.segments_sent(); });
  counter([] { return tr("Sequence errors"); }, [](const C& c) { return c.sequence_errors(); });
  counter([] { return tr("Underruns"); }, [](const C& c) { return c.underruns(); });
  counter([] { return tr("Unreadable frames"); }, [](const C& c) { return c.malformed_frames(); });
  counter([] { return tr("Frames of strangers"); }, [](const C& c) { return c.foreign_frames(); });
  counter([] { return tr("Slowed for the bus"); }, [](const C& c) { return c.bus_slowdowns(); });
  counter([] { return tr("Held for planning"); }, [](const C& c) { return c.starvation_holds(); });
  card->column()->addLayout(counters);
  grid->addWidget(card, 3, 0, 1, 2);
  for (int row = 0; row < 3; ++row) grid->setRowStretch(row, 1);
  return body;
}

void MachinePage::take_status() {
  const auto& machine = desk_.session.machine();
  if (!desk_.session.connected()) {
    summary_->setText(tr("Not connected."));
  } else {
    summary_->setText(tr("%1 · kinematics %2 · %3 axes on %4 nodes · bus %5")
                          .arg(Format::isolated(QString::fromStdString(machine.name())),
                               Format::isolated(QString::fromStdString(machine.kinematics())),
                               Format::number(machine.joints_size(), 0),
                               Format::number(machine.nodes_size(), 0),
                               Format::isolated(QString::fromStdString(machine.bus()))));
  }
  for (const int column : {AxesModel::kMeasured, AxesModel::kError})
    axes_->setColumnHidden(column, !desk_.axes.measured());
  for (const int column : {AxesModel::kByScale, AxesModel::kScaleError})
    axes_->setColumnHidden(column, !desk_.axes.scaled());
  if (tabs_->currentIndex() == 1)
    for (const auto& [label, value] : numbers_) label->setText(value());
}

}  // namespace kinebus::gui
