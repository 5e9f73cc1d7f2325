"use strict";
// Pictures: values of curves under the pointer, at a tap or by the arrow keys, curves switched off and on from the legend.
(() => {
  // Distances on the grid of a picture, in tenths of its pixels: what the pointer catches, and what looks like one point.
  const [NEAR, SAME] = [400, 30];
  // What a finger catches, in pixels of the screen, however small the picture is there.
  const FINGER = 24;
  const reading = document.createElement("div");
  reading.className = "reading";
  reading.hidden = true;
  reading.setAttribute("aria-live", "polite");
  document.body.append(reading);

  const axis = (words, from, to) => {
    const [scale, low, high] = [words.split(" ")[0], ...words.split(" ").slice(1).map(Number)];
    const log = scale === "log";
    return {
      at: value => from + ((log ? Math.log10(value) : value) - low) / (high - low) * (to - from),
      value: at => {
        const value = low + (at - from) / (to - from) * (high - low);
        return log ? 10 ** value : value;
      },
    };
  };

  // The points of what is drawn of one series: where they are, and what they say.
  const pointsOf = (group, x, y) => {
    const listed = group.dataset.points;
    if (listed === undefined) return [];
    if (listed) {
      return listed.split(" ").map(pair => pair.split(",").map(Number))
        .map(([a, b]) => ({ group, values: [a, b], at: [x.at(a), y.at(b)] }))
        .filter(point => point.at.every(Number.isFinite));
    }
    const corners = [...group.querySelectorAll("polyline")].flatMap(line => [...line.points]);
    return corners.map(corner => ({ group, values: [x.value(corner.x), y.value(corner.y)], at: [corner.x, corner.y] }));
  };

  const short = value => {
    const rounded = Number(value.toPrecision(5));
    const plain = rounded === 0 || (Math.abs(rounded) >= 1e-3 && Math.abs(rounded) < 1e6);
    return plain ? String(rounded) : rounded.toExponential();
  };

  const line = (tag, text) => {
    const row = document.createElement(tag);
    row.textContent = text;
    return row;
  };

  // Says what a point is, and what lies under the same marker.
  const show = (picture, point, others, [left, top]) => {
    const labels = [picture.dataset.xLabel, picture.dataset.yLabel].map(label => label.replace(" (dimensionless)", ""));
    const covers = other => other.group !== point.group
      && Math.hypot(other.at[0] - point.at[0], other.at[1] - point.at[1]) < SAME;
    const said = [point, ...others.filter(covers)].flatMap(({ group, values }) =>
      [line("b", group.dataset.series), ...labels.map((label, i) => line("div", `${label}: ${short(values[i])}`))]);
    reading.replaceChildren(...said);
    reading.hidden = false;
    const box = reading.getBoundingClientRect();
    reading.style.left = `${Math.max(4, Math.min(left + 14, innerWidth - box.width - 4))}px`;
    reading.style.top = `${top + 18 + box.height > innerHeight ? top - box.height - 12 : top + 18}px`;
    let ring = picture.querySelector(".ring");
    if (!ring) {
      ring = document.createElementNS("http://www.w3.org/2000/svg", "circle");
      ring.setAttribute("class", "ring");
      ring.setAttribute("r", 110);
      picture.append(ring);
    }
    ring.setAttribute("cx", point.at[0]);
    ring.setAttribute("cy", point.at[1]);
  };

  const hide = picture => {
    reading.hidden = true;
    picture.querySelector(".ring")?.remove();
  };

  const read = picture => {
    const [left, top, right, bottom] = picture.dataset.plot.split(" ").map(Number);
    const [x, y] = [axis(picture.dataset.x, left, right), axis(picture.dataset.y, bottom, top)];
    const groups = [...picture.querySelectorAll("[data-series]")];
    // Read at the first look: there are many pictures, and few are looked at.
    let all;
    const visible = () => (all ??= groups.flatMap(group => pointsOf(group, x, y)))
      .filter(point => !point.group.classList.contains("off"));
    const within = point => point.at[0] >= left - 1 && point.at[0] <= right + 1;

    const point = event => {
      const screen = picture.getScreenCTM();
      const { x: px, y: py } = new DOMPoint(event.clientX, event.clientY).matrixTransform(screen.inverse());
      let [nearest, least] = [null, Math.max(NEAR, FINGER / screen.a)];
      for (const point of visible()) {
        const distance = Math.hypot(point.at[0] - px, point.at[1] - py);
        if (distance < least && within(point)) [nearest, least] = [point, distance];
      }
      if (nearest) show(picture, nearest, visible(), [event.clientX, event.clientY]);
      else hide(picture);
    };
    picture.addEventListener("pointermove", point);
    // A finger that is lifted leaves the picture: what a tap shows stays until the next tap.
    picture.addEventListener("click", point);
    picture.addEventListener("pointerleave", event => {
      if (event.pointerType !== "touch") hide(picture);
    });
    document.addEventListener("pointerdown", event => {
      if (!picture.contains(event.target)) hide(picture);
    });

    // Left and right along a curve, up and down from curve to curve.
    let [series, place] = [0, -1];
    const walk = key => {
      const curves = groups.map(group => visible().filter(point => point.group === group && within(point)))
        .filter(points => points.length);
      if (!curves.length) return;
      if (key === "ArrowUp" || key === "ArrowDown") series += key === "ArrowUp" ? -1 : 1;
      series = (series + curves.length) % curves.length;
      const points = curves[series];
      const stride = Math.max(1, Math.round(points.length / 100));
      if (key === "ArrowLeft" || key === "ArrowRight") place += key === "ArrowLeft" ? -stride : stride;
      place = Math.max(0, Math.min(place, points.length - 1));
      const { x: px, y: py } = new DOMPoint(...points[place].at).matrixTransform(picture.getScreenCTM());
      show(picture, points[place], visible(), [px, py]);
    };
    if (groups.some(group => group.dataset.points !== undefined)) {
      picture.setAttribute("tabindex", "0");
      picture.addEventListener("keydown", event => {
        if (event.target !== picture) return;
        if (event.key === "Escape") hide(picture);
        if (!event.key.startsWith("Arrow")) return;
        event.preventDefault();
        walk(event.key);
      });
      picture.addEventListener("blur", () => hide(picture));
    }
  };

  // An entry of the legend is a button for what is drawn of its series.
  const makeSwitch = (picture, entry) => {
    const name = entry.dataset.entry;
    const drawn = [...picture.querySelectorAll("[data-series]")].filter(group => group.dataset.series === name);
    if (!drawn.length) return;
    const reach = document.createElementNS("http://www.w3.org/2000/svg", "rect");
    const flip = () => {
      const off = entry.classList.toggle("off");
      for (const group of drawn) group.classList.toggle("off", off);
      entry.setAttribute("aria-pressed", String(!off));
      hide(picture);
    };
    for (const [key, value] of [["role", "button"], ["tabindex", "0"], ["aria-pressed", "true"], ["aria-label", name]]) {
      entry.setAttribute(key, value);
    }
    reach.setAttribute("class", "reach");
    entry.prepend(reach);
    // What is folded has no size yet.
    const measure = () => {
      const box = entry.getBBox();
      if (reach.hasAttribute("width") || !box.width) return;
      for (const [key, value] of [["x", box.x], ["y", box.y - 30], ["width", box.width], ["height", box.height + 60]]) {
        reach.setAttribute(key, value);
      }
    };
    picture.addEventListener("pointerenter", measure);
    entry.addEventListener("click", flip);
    entry.addEventListener("keydown", event => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      flip();
    });
  };

  for (const picture of document.querySelectorAll("svg[data-plot]")) {
    // A picture with parts to be operated is more than an image to assistive technology.
    picture.setAttribute("role", "group");
    read(picture);
    for (const entry of picture.querySelectorAll("[data-entry]")) makeSwitch(picture, entry);
    // Browsers would show the picture's title over the values.
    const title = picture.querySelector("title");
    picture.setAttribute("aria-label", title.textContent);
    title.remove();
  }
})();
