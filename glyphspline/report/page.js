"use strict";
/* What all pages have: elements, numbers, the theme, downloads, and drawings that zoom and pan by their view box. */

const GS = {};

(() => {
  const SVG = "http://www.w3.org/2000/svg";
  const CLOSEST = 4000; // times

  /** Three digits; proven bounds are rounded up. */
  GS.number = (value, up = false) => {
    if (value === null || value === undefined) return "–";
    if (value === true) return "yes";
    if (value === false) return "no";
    if (Number.isInteger(value) && Math.abs(value) < 1e6) return String(value);
    let near = +value.toPrecision(3);
    if (up && near < value) near = +(near + 10 ** (Math.floor(Math.log10(value)) - 2)).toPrecision(3);
    return String(near).replace("-", "\u2212");
  };
  GS.svg = (name, attributes = {}, ...children) => {
    const node = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    node.append(...children);
    return node;
  };

  GS.element = (name, attributes = {}, ...children) => {
    const node = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
      if (key === "class") node.className = value;
      else if (key in node && key !== "list" && typeof value !== "string") node[key] = value;
      else node.setAttribute(key, value);
    }
    node.append(...children);
    return node;
  };

  /** Fills a list with so many at a time; its button shows how many are left. */
  GS.filled = (list, button, size, make, noun) => {
    let items = [], shown = 0;
    const more = () => {
      list.append(...items.slice(shown, shown + size).map(make));
      shown = Math.min(items.length, shown + size);
      button.hidden = shown === items.length;
      button.textContent = `Show ${Math.min(size, items.length - shown)} of ${items.length - shown} more ${noun}`;
    };
    button.addEventListener("click", more);
    return (chosen) => {
      items = chosen;
      shown = 0;
      list.replaceChildren();
      more();
    };
  };
  /** Offer a text as a file. */
  GS.download = (text, name, type) => {
    const url = URL.createObjectURL(new Blob([text], { type }));
    GS.element("a", { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  };

  document.getElementById("theme").addEventListener("click", () => {
    const dark = getComputedStyle(document.documentElement).colorScheme === "dark";
    document.documentElement.dataset.theme = dark ? "light" : "dark";
  });

  /** Make `svg` zoomable; returns {fit(box), follow(box), zoom(factor), pan(dx, dy), key(event), box()}. `changed` hears the scale. */
  GS.zoomable = (svg, changed = () => {}, mayDrag = () => true) => {
    let home = [0, 0, 1000, 1000], box = [...home];
    const fingers = new Map();

    /** Show the same as another drawing. */
    const follow = (to) => {
      box = [...to];
      svg.setAttribute("viewBox", box.map((v) => +v.toPrecision(9)).join(" "));
    };
    const show = () => {
      follow(box);
      changed(home[2] / box[2], unit());
    };
    /** Drawing units in a pixel, whatever side the view box is letterboxed on. */
    const unit = () => {
      const r = svg.getBoundingClientRect();
      return Math.max(box[2] / Math.max(r.width, 1), box[3] / Math.max(r.height, 1));
    };
    const place = (event) => {
      const r = svg.getBoundingClientRect(), u = unit();
      return [
        box[0] + box[2] / 2 + (event.clientX - r.left - r.width / 2) * u,
        box[1] + box[3] / 2 + (event.clientY - r.top - r.height / 2) * u,
      ];
    };
    const zoom = (factor, about = [box[0] + box[2] / 2, box[1] + box[3] / 2]) => {
      const width = Math.min(home[2] * 4, Math.max(home[2] / CLOSEST, box[2] / factor));
      const k = width / box[2];
      box = [about[0] + (box[0] - about[0]) * k, about[1] + (box[1] - about[1]) * k, width, box[3] * k];
      show();
    };
    const pan = (dx, dy) => {
      box[0] += dx;
      box[1] += dy;
      show();
    };
    const fit = (to = home) => {
      home = [...to];
      box = [...to];
      show();
    };

    svg.addEventListener("wheel", (event) => {
      event.preventDefault();
      zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.002)), place(event));
    }, { passive: false });
    svg.addEventListener("dblclick", (event) => zoom(event.shiftKey ? 1 / 3 : 3, place(event)));
    svg.addEventListener("pointerdown", (event) => {
      if (!mayDrag(event)) return;
      svg.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, event);
      svg.classList.add("dragging");
    });
    svg.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before) return;
      const other = [...fingers.values()].find((finger) => finger.pointerId !== event.pointerId);
      if (other) {
        const spread = (e) => Math.max(8, Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY));
        zoom(spread(event) / spread(before), place(other));
      } else {
        const u = unit();
        pan((before.clientX - event.clientX) * u, (before.clientY - event.clientY) * u);
      }
      fingers.set(event.pointerId, event);
    });
    const lift = (event) => {
      fingers.delete(event.pointerId);
      if (!fingers.size) svg.classList.remove("dragging");
    };
    svg.addEventListener("pointerup", lift);
    svg.addEventListener("pointercancel", lift);

    /** Arrow keys pan, + and - zoom, 0 fits; true if the key was one of these. */
    const key = (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return false;
      const step = box[2] / 12;
      const acts = {
        "+": () => zoom(1.5), "=": () => zoom(1.5), "-": () => zoom(1 / 1.5), 0: () => fit(),
        ArrowLeft: () => pan(-step, 0), ArrowRight: () => pan(step, 0), ArrowUp: () => pan(0, -step),
        ArrowDown: () => pan(0, step),
      };
      if (!acts[event.key]) return false;
      acts[event.key]();
      event.preventDefault();
      return true;
    };
    return { fit, follow, zoom, pan, key, place, unit, box: () => [...box] };
  };

  /** The same, with a ruler and buttons for zoom beside `svg`. */
  GS.stage = (svg, changed = () => {}, mayDrag = () => true) => {
    const ruler = GS.element("span", { class: "ruler" }), scale = GS.element("span");
    const zoom = GS.zoomable(svg, (times, unit) => {
      scale.textContent = `${times < 10 ? times.toFixed(1) : Math.round(times)}×`;
      // A round number of font units, so that a zoom means something.
      const most = 120 * unit, power = 10 ** Math.floor(Math.log10(most)), length = [5, 2, 1].find((k) => k * power <= most) * power;
      ruler.style.width = `${length / unit}px`;
      ruler.textContent = `${+length.toPrecision(2)} units`;
      changed();
    }, mayDrag);
    const buttons = [["−", "Zoom out", () => zoom.zoom(1 / 1.6)], ["+", "Zoom in", () => zoom.zoom(1.6)], ["Fit", "Fit", () => zoom.fit()]]
      .map(([text, label, act]) => {
        const button = GS.element("button", { type: "button", "aria-label": label }, text);
        button.addEventListener("click", act);
        return button;
      });
    svg.after(GS.element("div", { class: "over left" }, ruler),
      GS.element("div", { class: "over right", role: "group", "aria-label": "Zoom" }, scale, ...buttons));
    return zoom;
  };
})();
