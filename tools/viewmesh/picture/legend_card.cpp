#include "tools/viewmesh/picture/legend_card.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hexpipe::viewmesh::picture {
namespace {

// In ems.
constexpr double margin = 1, padding = 0.9, swatch = 0.75, swatch_step = 1.2, narrowest_card = 9;
// The card takes no more of the picture's width.
constexpr double greatest_share = 0.34;

}  // namespace

LegendCard::LegendCard(const Legend& legend, double em, int width, int height)
    : em_(em),
      normal_(em),
      small_(0.88 * em),
      title_(1.08 * em),
      large_(1.6 * em),
      width_(width),
      height_(height),
      ticks_(legend.ticks) {
  add_rows(legend);
  double widest = narrowest_card * em_;
  for (const Row& row : rows_) widest = std::max(widest, text_width(row));
  const double outer = std::min(widest + 2 * padding * em_, greatest_share * width_);
  box_ = {width_ - margin * em_ - outer, margin * em_, width_ - margin * em_,
          (margin + 2 * padding) * em_ + height_of_rows()};
}

void LegendCard::add_rows(const Legend& legend) {
  rows_.push_back({Style::title, legend.title});
  if (legend.share) {
    rows_.push_back({Style::share, *legend.share});
    rows_.push_back({Style::words, "of the volume in hexes"});
  }
  rows_.push_back({Style::subject, legend.subject});
  if (!ticks_.empty()) {
    rows_.push_back({Style::scale});
    rows_.push_back({Style::ticks});
  }
  const double room = height_ - 2 * (margin + padding) * em_ - height_of_rows();
  const auto most = static_cast<std::size_t>(std::max(1.0, room / height_of({Style::key})));
  for (std::size_t i = 0; i < legend.keys.size(); ++i) {
    if (i + 1 >= most && i + 1 < legend.keys.size()) {
      rows_.push_back({Style::words, fmt::format("and {} more", legend.keys.size() - i)});
      return;
    }
    rows_.push_back({Style::key, legend.keys[i].text, legend.keys[i].colour});
  }
}

double LegendCard::text_width(const Row& row) const {
  switch (row.style) {
    case Style::title:
      return title_.width(row.text, Weight::bold);
    case Style::share:
      return large_.width(row.text, Weight::bold);
    case Style::key:
      return swatch_step * em_ + normal_.width(row.text);
    default:
      return small_.width(row.text);
  }
}

double LegendCard::height_of(const Row& row) const {
  switch (row.style) {
    case Style::title:
      return 1.5 * em_;
    case Style::share:
      return 1.9 * em_;
    case Style::words:
      return 1.3 * em_;
    case Style::subject:
      return 1.7 * em_;
    case Style::scale:
      return 0.75 * em_;
    case Style::ticks:
      return 1.4 * em_;
    default:
      return 1.45 * em_;
  }
}

double LegendCard::height_of_rows() const {
  double sum = 0;
  for (const Row& row : rows_) sum += height_of(row);
  return sum;
}

Frame LegendCard::free_frame() const {
  if (height_ > width_) return {.top = 1 - 2 * (box_.bottom + margin * em_) / height_};
  return {.right = 2 * (box_.left - margin * em_) / width_ - 1};
}

void LegendCard::draw_ticks(Picture& picture, double baseline, const Rgb& colour) const {
  const double left = box_.left + padding * em_, width = box_.right - box_.left - 2 * padding * em_;
  for (std::size_t i = 0; i < ticks_.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(ticks_.size() - 1);
    // Below its place of the scale, but for the first and the last, which stay within its ends.
    const double own = small_.width(ticks_[i]);
    const double x = std::clamp(left + share * width - own / 2, left, left + width - own);
    small_.draw(picture, {x, baseline}, ticks_[i], colour);
  }
}

void LegendCard::draw_row(Picture& picture, const Row& row, double top, const Rgb& ink, const Rgb& soft) const {
  const double left = box_.left + padding * em_, right = box_.right - padding * em_;
  const double baseline = top + height_of(row) - 0.4 * em_;
  const auto fitting = [&](const Font& font, double room, Weight weight) {
    return font.cut_to(row.text, room, weight);
  };
  switch (row.style) {
    case Style::title:
      title_.draw(picture, {left, baseline}, fitting(title_, right - left, Weight::bold), ink, Weight::bold);
      break;
    case Style::share:
      large_.draw(picture, {left, baseline}, row.text, ink, Weight::bold);
      break;
    case Style::scale: {
      std::vector<Rgb> colours;
      for (const auto& colour : page_colours()["quality"]) colours.push_back(parse_colour(colour));
      fill_ramp(picture, {left, top + 0.1 * em_, right, top + 0.65 * em_}, 0.275 * em_, colours);
      break;
    }
    case Style::ticks:
      draw_ticks(picture, baseline, soft);
      break;
    case Style::key: {
      const double low = baseline + 0.06 * em_, text = left + swatch_step * em_;
      fill_box(picture, {left, low - swatch * em_, left + swatch * em_, low}, 0.2 * em_, row.colour);
      normal_.draw(picture, {text, baseline}, fitting(normal_, right - text, Weight::normal), ink);
      break;
    }
    default:
      small_.draw(picture, {left, baseline}, fitting(small_, right - left, Weight::normal), soft);
  }
}

void LegendCard::draw(Picture& picture, bool dark) const {
  const auto& theme = page_colours()[dark ? "dark" : "light"];
  const Rgb ink = parse_colour(theme["ink"]), soft = parse_colour(theme["soft"]);
  fill_box(picture, box_, 0.8 * em_, parse_colour(theme["card"]), 0.86);
  double top = box_.top + padding * em_;
  for (const Row& row : rows_) {
    draw_row(picture, row, top, ink, soft);
    top += height_of(row);
  }
}

}  // namespace hexpipe::viewmesh::picture
