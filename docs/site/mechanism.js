// The front page's mechanism: draws the cycles in `computed`, which scripts/build-site takes from the program.
(() => {
  const mm =
      {crank: 5, rod: 20, hinge: 6, wing: 63};  // data/designs/friction2022.toml; wings as docs/model.md section 5
  const slowdown = 100;
  const colours = {
    crank: 'var(--m-crank)',
    rod: 'var(--m-rod)',
    wing: 'var(--m-wing)',
    spring: 'var(--m-spring)',
    lift: 'var(--m-lift)',
    electrical: 'var(--m-wing)',
    friction: 'var(--m-crank)',
    aerodynamic: 'var(--m-rod)'
  };
  const make = (parent, tag, attributes, text) => {
    const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    if (text !== undefined) node.textContent = text;
    return parent.appendChild(node);
  };
  const line = (parent, colour, width, more) =>
      make(parent, 'line', {stroke: colour, 'stroke-width': width, 'stroke-linecap': 'round', ...more});
  const place = (node, a, b) => {
    for (const [name, value] of [['x1', a[0]], ['y1', -a[1]], ['x2', b[0]], ['y2', -b[1]]])
      node.setAttribute(name, value);
  };

  const drawing = document.getElementById('mechanism');
  const fixed = make(drawing, 'g', {});
  line(fixed, 'var(--m-faint)', 0.4, {x1: 0, y1: -30, x2: 0, y2: 8, 'stroke-dasharray': '1.5 1.2'});
  make(fixed, 'circle', {r: mm.crank, fill: 'none', stroke: 'var(--m-faint)', 'stroke-width': 0.4});
  const ghosts = Array.from(
      {length: 10}, (_, n) => [-1, 1].map(() => line(drawing, colours.wing, 0.7, {opacity: 0.05 + 0.02 * (10 - n)})));
  const springs = [-1, 1].map((side) => {
    let path = '';
    for (let n = 0; n <= 60; ++n) {
      const angle = n * 2.5 * 2 * Math.PI / 60, radius = 0.9 + 1.9 * n / 60;
      path += `${n ? 'L' : 'M'}${side * mm.hinge + radius * Math.cos(angle)},${- mm.rod + radius * Math.sin(angle)}`;
    }
    return make(drawing, 'path', {d: path, fill: 'none', stroke: colours.spring, 'stroke-width': 0.45});
  });
  const arms = [-1, 1].map(() => line(drawing, colours.wing, 0.9, {}));
  const wings = [-1, 1].map(() => make(drawing, 'polygon', {fill: colours.wing}));
  const rod = line(drawing, colours.rod, 1.4, {});
  const crank = line(drawing, colours.crank, 1.8, {});
  const joint = (x, y) => make(
      drawing, 'circle', {cx: x, cy: -y, r: 0.9, fill: 'var(--m-ground)', stroke: colours.wing, 'stroke-width': 0.4});
  joint(0, 0);
  for (const side of [-1, 1]) joint(side * mm.hinge, mm.rod);
  const pin = joint(0, 0);
  const slider =
      make(drawing, 'rect',
           {width: 2.6, height: 2.6, rx: 0.4, fill: 'var(--m-ground)', stroke: colours.wing, 'stroke-width': 0.45});
  const lifts = [-1, 1].map(() => line(drawing, colours.lift, 1, {}));
  const heads = [-1, 1].map(() => make(drawing, 'polygon', {fill: colours.lift}));
  const label = (x, y, text, colour) => make(drawing, 'text', {x, y, style: `fill:${colour}`, 'font-size': 4.2}, text);
  const liftLabel = label(0, 0, 'lift', colours.lift);
  label(8, 2, 'crank', colours.crank);
  label(2.4, -9.5, 'rod', colours.rod);
  const springLabel = label(10, -12.5, 'hinge spring', colours.spring);

  const chart = document.getElementById('cycle');
  const left = 34, width = 222, names = Object.keys(computed);
  const last = computed.off.cycle.lift_n.length - 1;
  const strip = (top, height, title, unit, rows) => {
    const values =
        names.flatMap((name) => rows.flatMap(([key]) => computed[name].cycle[key])).map((value) => 1e3 * value);
    const step = unit === 'mN' ? 10 : 250;
    const low = Math.floor(Math.min(0, ...values) / step) * step, high = Math.ceil(Math.max(...values) / step) * step;
    const y = (value) => top + height * (high - value) / (high - low);
    make(chart, 'text', {x: left, y: top - 6, class: 'title'}, `${title} (${unit})`);
    for (let tick = low; tick <= high; tick += step) {
      line(chart, 'var(--m-faint)', tick === 0 ? 1 : 0.5, {x1: left, x2: left + width, y1: y(tick), y2: y(tick)});
      make(chart, 'text', {x: left - 4, y: y(tick) + 3.5, 'text-anchor': 'end'}, String(tick).replace('-', '\u2212'));
    }
    const curves = rows.map(([key, name, colour]) => {
      const curve =
          make(chart, 'polyline', {fill: 'none', stroke: colour, 'stroke-width': 1.6, 'stroke-linejoin': 'round'});
      const text = name && make(chart, 'text', {x: left + width + 4, style: `fill:${colour}`}, name);
      return (cycle) => {
        curve.setAttribute('points',
                           cycle[key].map((value, n) => `${left + width * n / last},${y(1e3 * value)}`).join(' '));
        return text && {text, y: y(1e3 * cycle[key][last]) + 3.5};
      };
    });
    return (cycle) => {
      // Labels stand at their curves' ends, and not on each other.
      let above = -Infinity;
      for (const label of curves.map((curve) => curve(cycle)).filter(Boolean).sort((a, b) => a.y - b.y)) {
        above = Math.max(label.y, above + 12);
        label.text.setAttribute('y', above);
      }
    };
  };
  const strips = [
    strip(18, 74, 'lift', 'mN', [['lift_n', '', colours.lift]]),
    strip(118, 92, 'power', 'mW',
          [
            ['power_electrical_w', 'input', colours.electrical], ['power_friction_w', 'friction', colours.friction],
            ['power_aerodynamic_w', 'air', colours.aerodynamic]
          ]),
  ];
  make(chart, 'text', {x: left + width / 2, y: 228, 'text-anchor': 'middle'}, 'one flapping cycle');
  const cursor = line(chart, 'var(--m-cursor)', 1, {y1: 18, y2: 210});

  let springsState = 'off', phase = 0.12, before;
  const at = (values, position) => {
    const n = Math.min(Math.floor(position), last - 1);
    return values[n] + (position - n) * (values[n + 1] - values[n]);
  };
  const tip = (side, beta, length, across) => [side * (mm.hinge + length * Math.cos(beta) + across * Math.sin(beta)),
                                               mm.rod - length * Math.sin(beta) + across * Math.cos(beta)];
  const draw = () => {
    const {cycle} = computed[springsState], position = phase * last;
    const theta = at(cycle.crank_angle_rad, position), beta = at(cycle.stroke_angle_rad, position);
    const height = mm.rod + mm.hinge * Math.tan(beta);
    const end = [mm.crank * Math.cos(theta), mm.crank * Math.sin(theta)];
    place(crank, [0, 0], end);
    place(rod, end, [0, height]);
    pin.setAttribute('cx', end[0]);
    pin.setAttribute('cy', -end[1]);
    slider.setAttribute('x', -1.3);
    slider.setAttribute('y', -height - 1.3);
    const arrow = at(cycle.lift_n, position) * 1e3 * 0.9;
    [-1, 1].forEach((side, n) => {
      place(arms[n], [0, height], [side * mm.hinge, mm.rod]);
      wings[n].setAttribute('points', [
        tip(side, beta, 0, -0.7), tip(side, beta, mm.wing, -0.25), tip(side, beta, mm.wing, 0.25),
        tip(side, beta, 0, 0.7)
      ].map(([x, y]) => `${x},${- y}`).join(' '));
      const [x, y] = tip(side, beta, 0.7 * mm.wing, 0);
      place(lifts[n], [x, y], [x, y + arrow]);
      if (side > 0) {
        liftLabel.setAttribute('x', x + 2.5);
        liftLabel.setAttribute('y', -y - Math.max(arrow, 4) + 1);
      }
      heads[n].setAttribute(
          'points', arrow > 1 ? `${x - 1.5},${- y - arrow} ${x + 1.5},${- y - arrow} ${x},${- y - arrow - 3}` : '');
      ghosts.forEach((ghost, k) => {
        const past = (phase - 0.012 * (k + 1) + 1) % 1, angle = at(cycle.stroke_angle_rad, past * last);
        place(ghost[n], tip(side, angle, 0, 0), tip(side, angle, mm.wing, 0));
      });
    });
    for (const end of ['x1', 'x2']) cursor.setAttribute(end, left + width * phase);
  };
  const choose = (name) => {
    springsState = name;
    const {cycle, metrics} = computed[name];
    strips.forEach((strip) => strip(cycle));
    for (const node of [...springs, springLabel]) node.style.display = name === 'on' ? '' : 'none';
    document.querySelectorAll('[data-springs]')
        .forEach((button) => button.setAttribute('aria-pressed', button.dataset.springs === name));
    document.getElementById('readout').textContent = `${metrics.frequency_hz.toFixed(2)} Hz \u00b7 lift ` +
        `${(1e3 * metrics.lift_mean_n).toFixed(2)} mN \u00b7 input ${
                                                         (1e3 * metrics.power_electrical_w).toFixed(0)} mW \u00b7 ` +
        `friction ${(1e3 * metrics.power_friction_w).toFixed(0)} mW \u00b7 efficiency ` +
        `${(1e2 * metrics.efficiency_system).toFixed(1)} %`;
    draw();
  };

  const button = document.getElementById('motion');
  let moving = !matchMedia('(prefers-reduced-motion: reduce)').matches;
  const frame = (now) => {
    if (!moving) return;
    const period = 1e3 * slowdown / computed[springsState].metrics.frequency_hz;
    if (before !== undefined) phase = (phase + Math.min(now - before, 100) / period) % 1;
    before = now;
    draw();
    requestAnimationFrame(frame);
  };
  const show = () => {
    button.textContent = moving ? 'pause' : 'play';
    before = undefined;
    if (moving) requestAnimationFrame(frame);
  };
  button.addEventListener('click', () => {
    moving = !moving;
    show();
  });
  document.querySelectorAll('[data-springs]')
      .forEach((one) => one.addEventListener('click', () => choose(one.dataset.springs)));
  choose('off');
  show();
})();
