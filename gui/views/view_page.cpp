#include "gui/views/view_page.hpp"

#include <QHBoxLayout>
#include <QSettings>
#include <QSignalBlocker>
#include <QSizePolicy>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWidget>
#include <algorithm>
#include <array>

#include "gui/models/format.hpp"
#include "gui/models/machine_picture.hpp"

namespace kinebus::gui {

ViewPage::ViewPage(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  scene_ = new SceneView(this);
  layers_ = new QSlider(Qt::Vertical, this);
  first_layer_ = new QSlider(Qt::Vertical, this);
  moves_ = new QSlider(Qt::Horizontal, this);
  layer_text_ = make_label("small", this);
  broken_ = make_label("danger", this);
  wrap_words(*broken_);
  broken_->hide();

  auto* side = new QVBoxLayout;
  side->setSpacing(6);
  auto* handles = new QHBoxLayout;
  handles->setSpacing(2);
  handles->addWidget(first_layer_);
  handles->addWidget(layers_);
  side->addLayout(handles, 1);
  side->addWidget(layer_text_, 0, Qt::AlignHCenter);
  layer_text_->setAlignment(Qt::AlignCenter);
  layer_text_->setMinimumWidth(58);

  auto* middle = new QHBoxLayout;
  middle->setSpacing(8);
  auto* seen = new QVBoxLayout;
  seen->setSpacing(4);
  seen->addWidget(scene_, 1);
  seen->addWidget(moves_);
  middle->addLayout(seen, 1);
  middle->addLayout(side);

  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(12, 10, 12, 10);
  column->setSpacing(8);
  column->addWidget(make_tools());
  column->addWidget(broken_);
  column->addLayout(middle, 1);
  column->addWidget(make_bottom());

  connect(scene_, &SceneView::broken, this, [this](const QString& why) {
    broken_->setText(tr("The 3D scene cannot be shown: %1").arg(why.trimmed()));
    broken_->show();
  });
  connect(layers_, &QSlider::valueChanged, this, [this](int top) {
    first_layer_->setValue(std::min(first_layer_->value(), top));
    take_top_layer();
    take_sliders();
  });
  connect(first_layer_, &QSlider::valueChanged, this, [this](int bottom) {
    layers_->setValue(std::max(layers_->value(), bottom));
    take_sliders();
  });
  connect(moves_, &QSlider::valueChanged, this, &ViewPage::take_sliders);
  connect(&desk_.session, &Session::status_changed, this, &ViewPage::take_status);
  connect(&desk_.session, &Session::machine_changed, this, [this] {
    const auto model = model_of(desk_.session.machine());
    scene_->content().has_machine = model.has_value();
    if (model) scene_->content().model = *model;
    fitted_ = false;
    seen_status_.clear();
    printed_.forget();
    take_status();
  });
  connect(&desk_.path, &PathSource::chosen, this, [this] {
    // Who looks at a job is done with what the last one has left.
    if (!desk_.session.status().job().empty()) return;
    printed_.forget();
    take_status();
  });
  connect(&desk_.path, &PathSource::changed, this, &ViewPage::take_path);
  connect(&desk_.theme, &Theme::changed, this, &ViewPage::take_theme);
  take_theme();
  take_path();
  says([this] {
    scene_->setAccessibleName(tr("Scene: machine and tool path"));
    layers_->setToolTip(tr("Show the layers up to here"));
    layers_->setAccessibleName(layers_->toolTip());
    first_layer_->setToolTip(tr("Show the layers from here on"));
    first_layer_->setAccessibleName(first_layer_->toolTip());
    moves_->setToolTip(tr("Show the topmost layer's moves up to here"));
    moves_->setAccessibleName(moves_->toolTip());
    speak_direction(*moves_);
    tell_legend();
    tell_job();
    tell_layer();
  });
}

QWidget* ViewPage::make_tools() {
  auto* bar = new QWidget(this);
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(3);
  auto* colour_label = make_label("muted", bar);
  colouring_ = new QComboBox(bar);
  colouring_->addItems({{}, {}, {}, {}, {}});
  row->addWidget(colour_label);
  row->addSpacing(4);
  row->addWidget(colouring_);
  row->addSpacing(14);
  const auto toggle = [&](const char* icon, bool on, auto change) {
    QToolButton* tool = make_tool(desk_.theme, QString::fromLatin1(icon), true, bar);
    tool->setChecked(on);
    row->addWidget(tool);
    connect(tool, &QToolButton::toggled, this, [this, change](bool checked) {
      change(scene_->content(), checked);
      scene_->redraw();
    });
    return tool;
  };
  machine_ = toggle("arm", true, [](SceneContent& c, bool on) { c.show_machine = on; });
  reach_ = toggle("reach", true, [](SceneContent& c, bool on) { c.show_reach = on; });
  travel_ = toggle("travel", false, [](SceneContent& c, bool on) { c.show_travel = on; });
  remaining_ = toggle("remaining", true, [](SceneContent& c, bool on) { c.show_remaining = on; });
  trail_ = toggle("trail", false,
                  [this](SceneContent& c, bool on) { c.trail = on ? desk_.trail.lines() : nullptr; });
  row->addStretch(1);
  const auto look = [&](const char* icon, auto action) {
    QToolButton* tool = make_tool(desk_.theme, QString::fromLatin1(icon), false, bar);
    row->addWidget(tool);
    connect(tool, &QToolButton::clicked, this, action);
    return tool;
  };
  auto* diagonal = look("iso", [this] { scene_->look(SceneView::Look::kDiagonal); });
  auto* top = look("top", [this] { scene_->look(SceneView::Look::kTop); });
  auto* front = look("front", [this] { scene_->look(SceneView::Look::kFront); });
  row->addSpacing(8);
  auto* fit_machine = look("view", [this] { scene_->fit_machine(); });
  auto* fit_part = look("fit", [this] { scene_->fit_part(); });
  connect(colouring_, &QComboBox::currentIndexChanged, this, [this](int i) {
    scene_->content().colouring = static_cast<PathColouring>(std::max(0, i));
    tell_legend();
    scene_->redraw();
  });
  says([=, this] {
    colour_label->setText(tr("Colour by"));
    colouring_->setItemText(0, tr("Feed"));
    colouring_->setItemText(1, tr("Layer"));
    colouring_->setItemText(2, tr("Limit margin"));
    colouring_->setItemText(3, tr("As a body"));
    colouring_->setItemText(4, tr("Kind of line"));
    colouring_->setAccessibleName(tr("Colour of the tool path"));
    const auto name = [](QToolButton* tool, const QString& words) {
      tool->setToolTip(words);
      tool->setAccessibleName(words);
    };
    name(machine_, tr("Machine"));
    name(reach_, tr("Reach of the tool"));
    name(travel_, tr("Moves without extrusion"));
    name(remaining_, tr("What is not printed yet"));
    tell_trail();
    name(diagonal, tr("From a corner"));
    name(top, tr("From above"));
    name(front, tr("From the front"));
    name(fit_machine, tr("Whole machine (M)"));
    name(fit_part, tr("The part alone (F)"));
  });
  return bar;
}

QWidget* ViewPage::make_bottom() {
  auto* bar = new QWidget(this);
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(12);
  job_text_ = new ElidedLabel(bar);
  job_text_->setProperty("role", "muted");
  job_text_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  loading_ = new QProgressBar(bar);
  loading_->setRange(0, 100);
  loading_->setTextVisible(false);
  loading_->setFixedWidth(140);
  loading_->hide();
  legend_ = new RampLegend(bar);
  row->addWidget(job_text_, 1);
  row->addWidget(loading_);
  row->addWidget(legend_);
  return bar;
}

void ViewPage::take_theme() {
  scene_->content().colours = desk_.theme.scene();
  scene_->redraw();
}

void ViewPage::take_status() {
  SceneContent& content = scene_->content();
  const joblink::Status& status = desk_.session.status();
  const bool of_shown = desk_.path.name() == QString::fromStdString(status.job());
  printed_.follow(status, of_shown ? shown_ : nullptr);
  if (content.has_machine) {
    content.figure =
        pose_machine(content.model, pose_of(status), status.hotend().actual_celsius() > 50, &printed_.body());
    if (!fitted_ && status.has_tool()) {
      fitted_ = true;
      content.camera = {};
      scene_->look(SceneView::Look::kDiagonal);
      scene_->fit_machine();
    }
  }
  content.done_vertex = printed_.done_vertex(shown_);
  // A status that changes nothing to be seen lets the picture come to rest.
  std::string seen = status.tool().SerializeAsString() + std::to_string(content.done_vertex);
  for (const double joint : status.joints()) seen += ' ' + std::to_string(joint);
  seen += status.hotend().actual_celsius() > 50 ? 'h' : 'c';
  seen += content.figure.close_to_print ? 'n' : 'f';
  if (seen == seen_status_) return;
  seen_status_ = std::move(seen);
  if (!isVisible()) return;
  if (trail_->isChecked()) {
    content.trail = desk_.trail.lines();
    tell_trail();
  }
  scene_->redraw();
}

void ViewPage::tell_trail() {
  const QString name = tr("Where the tool went in the last five minutes");
  trail_->setAccessibleName(name);
  trail_->setToolTip(desk_.trail.measured()
                         ? tr("%1, by the encoders: at most %2 mm from where it should have been")
                               .arg(name, Format::isolated(Format::number(desk_.trail.farthest_off_mm(), 3)))
                         : tr("%1, as commanded: no axis has an encoder").arg(name));
}

void ViewPage::take_path() {
  loading_->setVisible(desk_.path.loading());
  loading_->setValue(static_cast<int>(desk_.path.progress() * 100));
  if (shown_ != desk_.path.scene()) {
    shown_ = desk_.path.scene();
    const int layers = shown_ == nullptr ? 0 : static_cast<int>(shown_->path.layers.size());
    for (QSlider* slider : {layers_, first_layer_}) {
      slider->setRange(0, std::max(0, layers - 1));
      slider->setEnabled(layers > 1);
    }
    layers_->setValue(layers_->maximum());
    first_layer_->setValue(0);
    take_top_layer();
    take_sliders();
    scene_->set_path(shown_);
    take_status();
    tell_legend();
    tell_layer();
    if (wanted_line_ != 0 && shown_ != nullptr) show_line(wanted_line_);
  }
  tell_job();
}

void ViewPage::tell_legend() {
  const auto colouring = scene_->content().colouring;
  const bool scale = shown_ != nullptr && colouring != PathColouring::kPart;
  legend_->setVisible(scale);
  if (!scale) return;
  switch (colouring) {
    case PathColouring::kFeed:
      legend_->set(colouring, Format::number(shown_->shades.feed_min_mm_per_min / 60.0, 0),
                   tr("%1 mm/s").arg(Format::number(shown_->shades.feed_max_mm_per_min / 60.0, 0)));
      break;
    case PathColouring::kLayer:
      legend_->set(colouring, Format::number(1, 0),
                   Format::number(static_cast<double>(shown_->path.layers.size()), 0));
      break;
    case PathColouring::kMargin:
      legend_->set(colouring, tr("at a limit"), tr("free"));
      break;
    case PathColouring::kFeature:
      legend_->set(kinds_of(shown_->path));
      break;
    case PathColouring::kPart:
      break;
  }
}

void ViewPage::tell_job() {
  const PathSource& path = desk_.path;
  if (!path.error().isEmpty()) {
    job_text_->set_text(tr("%1 cannot be shown: %2").arg(path.name(), path.error()));
  } else if (path.loading()) {
    job_text_->set_text(tr("Reading %1").arg(path.name()));
  } else if (shown_ != nullptr) {
    QString words = tr("%1 · %2 lines · %3 layers · %4 m of path")
                        .arg(Format::isolated(path.name()), Format::number(shown_->path.line_count, 0),
                             Format::number(static_cast<double>(shown_->path.layers.size()), 0),
                             Format::number(shown_->path.work_length_mm / 1000, 1));
    if (shown_->path.refused_lines > 0)
      words += QStringLiteral(" · ") + tr("%Ln line(s) are refused and not drawn", nullptr,
                                          static_cast<int>(shown_->path.refused_lines));
    job_text_->set_text(words);
  } else {
    job_text_->set_text(tr("No job is shown. Choose one on the Jobs page."));
  }
}

void ViewPage::take_top_layer() {
  const QSignalBlocker quiet(moves_);
  int moves = 0;
  if (shown_ != nullptr && !shown_->path.layers.empty()) {
    const PathLayer& top = shown_->path.layers[static_cast<std::size_t>(layers_->value())];
    moves = static_cast<int>(top.last - top.first);
  }
  moves_->setRange(0, moves);
  moves_->setPageStep(std::max(1, moves / 20));
  moves_->setValue(moves);
  moves_->setEnabled(moves > 1);
}

void ViewPage::take_sliders() {
  SceneContent& content = scene_->content();
  const int top = layers_->value();
  content.first_layer = static_cast<std::uint32_t>(first_layer_->value());
  content.last_layer = top >= layers_->maximum() ? UINT32_MAX : static_cast<std::uint32_t>(top);
  content.end_vertex = UINT32_MAX;
  if (shown_ != nullptr && moves_->value() < moves_->maximum())
    content.end_vertex = shown_->path.layers[static_cast<std::size_t>(top)].first +
                         static_cast<std::uint32_t>(moves_->value());
  tell_layer();
  scene_->redraw();
}

std::vector<RampLegend::Kind> ViewPage::kinds_of(const ToolPath& path) {
  const std::array<QString, kPathFeatures> names{tr("other"),   tr("outer wall"),     tr("inner wall"),
                                                 tr("infill"),  tr("top and bottom"), tr("bridge"),
                                                 tr("support"), tr("skirt and brim"), tr("gap")};
  std::array<bool, kPathFeatures> there{};
  for (const FeatureScanner::Change& change : path.features)
    there[static_cast<std::size_t>(change.feature)] = true;
  there[0] = there[0] || path.features.empty();
  std::vector<RampLegend::Kind> kinds;
  for (std::size_t i = 0; i < kPathFeatures; ++i)
    if (there[i]) kinds.push_back({colour_ramp(PathColouring::kFeature)[i], names[i]});
  return kinds;
}

void ViewPage::tell_layer() {
  if (shown_ == nullptr || shown_->path.layers.empty()) {
    layer_text_->setText(QStringLiteral("–"));
    return;
  }
  const auto i = static_cast<std::size_t>(layers_->value());
  layer_text_->setText(QStringLiteral("%1\n%2").arg(
      Format::number(static_cast<double>(i + 1), 0),
      Format::isolated(
          tr("%1 mm").arg(Format::number(static_cast<double>(shown_->path.layers[i].z_mm), 2)))));
}

void ViewPage::show_line(std::uint32_t line) {
  wanted_line_ = 0;
  if (shown_ == nullptr) {
    wanted_line_ = line;  // comes with the path
    return;
  }
  const auto vertex = shown_->path.vertex_at_line(line);
  layers_->setValue(static_cast<int>(shown_->path.layer_at_vertex(vertex)));
  scene_->show_vertex(static_cast<std::uint32_t>(std::min(vertex, shown_->path.size() - 1)));
}

void ViewPage::set_colouring(PathColouring colouring) {
  colouring_->setCurrentIndex(static_cast<int>(colouring));
}

void ViewPage::save(QSettings& settings) const {
  settings.setValue(QStringLiteral("view/colouring"), colouring_->currentIndex());
  settings.setValue(QStringLiteral("view/machine"), machine_->isChecked());
  settings.setValue(QStringLiteral("view/reach"), reach_->isChecked());
  settings.setValue(QStringLiteral("view/travel"), travel_->isChecked());
  settings.setValue(QStringLiteral("view/remaining"), remaining_->isChecked());
  settings.setValue(QStringLiteral("view/trail"), trail_->isChecked());
}

void ViewPage::restore(QSettings& settings) {
  colouring_->setCurrentIndex(settings.value(QStringLiteral("view/colouring"), 0).toInt());
  machine_->setChecked(settings.value(QStringLiteral("view/machine"), true).toBool());
  reach_->setChecked(settings.value(QStringLiteral("view/reach"), true).toBool());
  travel_->setChecked(settings.value(QStringLiteral("view/travel"), false).toBool());
  remaining_->setChecked(settings.value(QStringLiteral("view/remaining"), true).toBool());
  trail_->setChecked(settings.value(QStringLiteral("view/trail"), false).toBool());
}

}  // namespace kinebus::gui
