"use strict";
const reveal = () => {
  let name = location.hash.slice(1);
  try { name = decodeURIComponent(name); } catch { return; }
  const target = name && document.getElementById(name);
  if (!target) return;
  for (let e = target; e; e = e.parentElement) {
    if (e.tagName === "DETAILS") e.open = true;
    if (e.dataset && e.dataset.k !== undefined) e.hidden = false;
  }
  target.scrollIntoView();
};
addEventListener("hashchange", reveal);
reveal();

(() => {
  const form = document.querySelector(".filters");
  if (!form) return;
  const rows = [...document.querySelectorAll("#findings-table tbody tr")];
  const others = [...document.querySelectorAll(".tl[data-k], .moment[data-k]")];
  const drives = [...document.querySelectorAll(".drive[data-drive]")];
  const text = form.elements.text;
  const selects = [...form.querySelectorAll("select")];
  const output = form.querySelector("output");
  const words = new Map();
  const said = (e) => {
    if (!words.has(e)) {
      const titles = [...e.querySelectorAll("[title]")].map((t) => t.title).join(" ");
      words.set(e, `${e.textContent} ${titles}`.toLowerCase());
    }
    return words.get(e);
  };
  const apply = () => {
    const asked = text.value.toLowerCase().split(/\s+/).filter(Boolean);
    const chosen = selects.filter((s) => s.value && s.name !== "drive").map((s) => s.value);
    const drive = form.elements.drive ? form.elements.drive.value : "";
    const keep = (e) => {
      const keys = e.dataset.k.split(" ");
      return chosen.every((c) => keys.includes(c)) && asked.every((w) => said(e).includes(w));
    };
    let shown = 0;
    for (const row of rows) {
      row.hidden = !(keep(row) && (!drive || row.dataset.drive === drive));
      shown += row.hidden ? 0 : 1;
    }
    for (const e of others) e.hidden = !keep(e);
    for (const d of drives) d.hidden = Boolean(drive) && d.dataset.drive !== drive;
    output.textContent = shown === rows.length ? `${shown} shown` : `${shown} of ${rows.length} shown`;
  };
  form.hidden = false;
  form.addEventListener("input", apply);
  form.addEventListener("change", apply);
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("reset", () => setTimeout(apply));
  apply();
})();

(() => {
  // the printed page is the incident report: the drives with findings, and in them the moments that tell what happened
  const most = 12;
  let opened = [];
  addEventListener("beforeprint", () => {
    const drives = [...document.querySelectorAll(".drive.telling")].slice(0, most);
    const inside = drives.flatMap((d) => [...d.querySelectorAll(".ego.telling, .moment.leading, .quality")]);
    opened = [...drives, ...inside, ...document.querySelectorAll(".overtake")].filter((e) => !e.open);
    for (const e of opened) e.open = true;
  });
  addEventListener("afterprint", () => {
    for (const e of opened) e.open = false;
  });
})();
