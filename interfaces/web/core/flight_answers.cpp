#include "flown.hpp"
#include "report/described.hpp"

namespace wingbeat::web {
namespace {

using described::Description;

const Description<FlownControl>& control_description() {
  using R = FlownControl;
  static const Description<R> description = Description<R>()
                                                .always("name", "", "", &R::name)
                                                .always("unit", "", "", &R::unit)
                                                .always("trimmed", "", "at hover", &R::trimmed, schema::any_number)
                                                .always("low", "", "end of its range", &R::low, schema::any_number)
                                                .always("high", "", "", &R::high, schema::any_number);
  return description;
}

const Description<FlownWing>& wing_description() {
  using R = FlownWing;
  static const Description<R> description =
      Description<R>()
          .always("side", "", "+1 right, -1 left", &R::side, schema::any_number)
          .always("sense", "", "-1: it flaps against the stroke angle", &R::sense, schema::any_number)
          .always(
              "shoulder", "m", "in body axes: forward, right, down",
              [](const R& r) { return Json{r.shoulder[0], r.shoulder[1], r.shoulder[2]}; },
              schema::listed(schema::any_number));
  return description;
}

const Description<FlightBegun>& begun_description() {
  using R = FlightBegun;
  static const Description<R> description =
      Description<R>()
          .always("flies", "", "trimmed at hover", [](const R& r) { return r.trim.flies(); })
          .always("status", "", "of the trim", [](const R& r) { return r.trim.status; })
          .always("detail", "", "a sentence", &R::detail)
          .always("controller", "", "", &R::controller)
          .always("frequency_hz", "Hz", "of the wings at hover", [](const R& r) { return r.trim.frequency; })
          .always("power_w", "W", "mean electrical power at hover", [](const R& r) { return r.trim.power; })
          .always("control_rate_hz", "Hz", "", &R::control_rate)
          .always("delay_s", "s", "that the controller is designed for", &R::delay)
          .always("row_period_s", "s", "", &R::row_period)
          .always("height_m", "m", "at the start, over the ground", &R::height, schema::any_number)
          .always("amplitude", "", "the voltage is the amplitude of a wave", &R::amplitude)
          .parts("controls", "", control_description(), &R::controls)
          .always("uncontrolled", "", "a sentence for each axis without control", &R::uncontrolled)
          .parts("wings", "", wing_description(), &R::wings)
          .always(
              "outline", "m", "of a wing: distance from the stroke axis and chord",
              [](const R& r) {
                Json pairs = Json::array();
                for (const auto& [radius, chord] : r.outline) pairs.push_back({radius, chord});
                return pairs;
              },
              schema::listed(schema::pair_of(schema::any_number)));
  return description;
}

const Description<FlightPiece>& piece_description() {
  using R = FlightPiece;
  static const Description<R> description = Description<R>()
                                                .always("time_s", "s", "at its end", &R::time, schema::any_number)
                                                .always("flies", "", "false: the flight has ended", &R::flies)
                                                .always("outcome", "", "of a flight that has ended", &R::outcome)
                                                .always("detail", "", "a sentence where it has ended", &R::detail)
                                                .always("charge", "1", "of a battery", &R::charge);
  return description;
}

}  // namespace

Json begun_answer(const FlightBegun& begun) { return begun_description().json(begun); }
Json piece_answer(const FlightPiece& piece) { return piece_description().json(piece); }

Json flight_schemas() {
  return {{"FlightBegun", begun_description().schema()}, {"FlightPiece", piece_description().schema()}};
}

}  // namespace wingbeat::web
