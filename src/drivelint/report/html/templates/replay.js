(() => {
  const gap = 100; // hundredths of a second: further apart nobody knows where they were between
  const sum = (steps) => { let at = 0; return steps.map((step) => (at += step)); };
  const decoded = new WeakMap();
  const tracks = (drive) => {
    if (!decoded.has(drive)) {
      const told = drive.querySelector("script.tracks");
      const data = told ? JSON.parse(told.textContent) : { a: {}, s: {} };
      for (const who of Object.keys(data.a)) data.a[who] = data.a[who].map(sum);
      decoded.set(drive, data);
    }
    return decoded.get(drive);
  };
  const place = ([t, x, y, yaw], at) => {
    let high = t.findIndex((v) => v >= at);
    if (high < 0) return null;
    if (t[high] === at || high === 0) return t[high] === at ? [x[high], y[high], yaw[high]] : null;
    const low = high - 1;
    if (t[high] - t[low] > gap) return null;
    const u = (at - t[low]) / (t[high] - t[low]);
    return [x, y, yaw].map((v) => v[low] + u * (v[high] - v[low]));
  };
  const nearest = (times, at) => {
    let best = null;
    for (const t of times) if (Math.abs(t - at) <= 15 && (best === null || Math.abs(t - at) < Math.abs(best - at))) best = t;
    return best;
  };

  const start = (scene) => {
    const drive = scene.closest(".drive") || [...document.querySelectorAll(".drive")].find((d) => d.dataset.drive === scene.dataset.of);
    const picture = scene.querySelector("svg.plan");
    const data = picture && drive && tracks(drive);
    const own = data && data.a[scene.dataset.ego];
    if (!own || own[0].length < 2) return;
    const moment = Number(scene.dataset.t);
    const inside = own[0].filter((t) => Math.abs(t - moment) <= 502);
    const range = scene.querySelector("input");
    const output = scene.querySelector("output");
    const button = scene.querySelector("button");
    const cam = picture.querySelector(".cam");
    const spaces = picture.querySelector(".spaces");
    const still = spaces.innerHTML;
    const rings = data.s[scene.dataset.ego] || {};
    const frames = Object.keys(rings).map(Number);
    const map = cam.querySelector("g").transform.baseVal.consolidate().matrix;
    const bodies = [...picture.querySelectorAll("use[data-actor]")].map((g) => ({ g, home: g.getAttribute("transform"), who: g.dataset.actor }));
    const labels = [...picture.querySelectorAll("text[data-actor]")];
    const charts = [...scene.parentElement.querySelectorAll(".chart")].map((c) => [c, 42, 370]);
    charts.push(...[...scene.querySelectorAll(".strips")].map((c) => [c, 46, 546]));
    const width = 600;
    const view = ([x, y]) => [map.a * x / 10 + map.c * y / 10 + map.e, map.b * x / 10 + map.d * y / 10 + map.f];
    range.min = inside[0];
    range.max = inside[inside.length - 1];
    range.value = moment;
    const home = (b) => data.a[b.who] && place(data.a[b.who], moment);

    const show = (at) => {
      const here = Math.abs(at - moment) < 1;
      picture.classList.toggle("away", !here);
      for (const b of bodies) {
        const p = here ? null : data.a[b.who] && place(data.a[b.who], at);
        b.g.setAttribute("visibility", here || p ? "visible" : "hidden");
        b.g.setAttribute("transform", p ? `translate(${p[0] / 10},${p[1] / 10})rotate(${(p[2] * 0.18 / Math.PI * 10).toFixed(2)})` : b.home);
        for (const label of labels) {
          if (label.dataset.actor !== b.who) continue;
          const h = home(b);
          const [dx, dy] = p && h ? [0, 1].map((i) => view(p)[i] - view(h)[i]) : [0, 0];
          label.setAttribute("transform", `translate(${dx.toFixed(1)},${dy.toFixed(1)})`);
          label.setAttribute("visibility", here || p ? "visible" : "hidden");
        }
      }
      const ego = place(own, at);
      if (ego) { // the ego never leaves the picture
        const x = view(ego)[0];
        const shift = here ? 0 : x < 0.15 * width ? 0.15 * width - x : x > 0.85 * width ? 0.85 * width - x : 0;
        cam.setAttribute("transform", `translate(${shift.toFixed(1)},0)`);
      }
      if (here) spaces.innerHTML = still;
      else {
        const t = still ? nearest(frames, at) : null;
        spaces.replaceChildren(...Object.entries(t === null ? {} : rings[t]).map(([who, d]) => {
          const path = document.createElementNS(spaces.namespaceURI, "path");
          path.setAttribute("class", `space s-${who === scene.dataset.ego ? "ego" : "met"}`);
          path.setAttribute("d", d);
          return path;
        }));
      }
      for (const [chart, left, across] of charts) {
        const [from, to] = [Number(chart.dataset.from), Number(chart.dataset.to)];
        const cursor = chart.querySelector(".cursor");
        const x = left + across * (at - from) / (to - from);
        cursor.setAttribute("visibility", !here && at >= from && at <= to ? "visible" : "hidden");
        cursor.setAttribute("transform", `translate(${x.toFixed(1)},0)`);
      }
      output.textContent = `${(at / 100).toFixed(2)} s`;
    };

    range.addEventListener("input", () => show(Number(range.value)));
    let playing = 0;
    const stop = () => { cancelAnimationFrame(playing); playing = 0; };
    button.addEventListener("click", () => {
      if (playing) return stop();
      if (Number(range.value) >= Number(range.max)) range.value = range.min;
      const from = Number(range.value);
      const began = performance.now();
      const tick = (now) => {
        const at = Math.min(from + (now - began) / 10, Number(range.max));
        range.value = at;
        show(at);
        if (at < Number(range.max)) playing = requestAnimationFrame(tick); else stop();
      };
      playing = requestAnimationFrame(tick);
    });
    range.addEventListener("pointerdown", stop);
    range.addEventListener("keydown", stop);
    addEventListener("beforeprint", () => { stop(); range.value = moment; show(moment); });
    scene.querySelector(".replay").hidden = false;
  };

  const ready = new WeakSet();
  const wake = (details) => {
    for (const scene of details.querySelectorAll(".scene")) {
      if (ready.has(scene) || !scene.closest(".moment").open) continue;
      ready.add(scene);
      start(scene);
    }
  };
  // `toggle` does not bubble, and what is never opened is never prepared
  document.addEventListener("toggle", (event) => {
    if (event.target.open && event.target.matches(".drive, .ego, .moment")) wake(event.target);
  }, true);
  for (const details of document.querySelectorAll(".moment[open]")) wake(details);
  for (const scene of document.querySelectorAll(".hero .scene")) start(scene);
})();
