"use strict";
(() => {
  const form = document.querySelector(".filters");
  if (form) {
    const rows = [...document.querySelectorAll("#findings-table tbody tr")];
    const selects = [...form.querySelectorAll("select")];
    const output = form.querySelector("output");
    const apply = () => {
      let shown = 0;
      for (const row of rows) {
        const keep = selects.every((s) => !s.value || row.dataset[s.name] === s.value);
        row.hidden = !keep;
        shown += keep ? 1 : 0;
      }
      output.textContent = shown === rows.length ? `${shown} shown` : `${shown} of ${rows.length} shown`;
    };
    form.hidden = false;
    form.addEventListener("change", apply);
    form.addEventListener("submit", (event) => event.preventDefault());
    form.addEventListener("reset", () => setTimeout(apply));
    apply();
  }
  const reveal = () => {
    let name = location.hash.slice(1);
    try { name = decodeURIComponent(name); } catch { return; }
    const target = name && document.getElementById(name);
    if (!target) return;
    for (let e = target; e; e = e.parentElement) if (e.tagName === "DETAILS") e.open = true;
    target.scrollIntoView();
  };
  addEventListener("hashchange", reveal);
  reveal();
  let opened = [];
  addEventListener("beforeprint", () => {
    opened = [...document.querySelectorAll("details:not([open])")];
    for (const e of opened) e.open = true;
  });
  addEventListener("afterprint", () => {
    for (const e of opened) e.open = false;
  });
})();
