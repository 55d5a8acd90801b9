// sections out of sight have an estimated height: what is on the way to the target would move it as it is laid out
const goTo = (target) => {
  document.body.classList.add("laid-out");
  target.scrollIntoView();
};
const reveal = () => {
  let name = location.hash.slice(1);
  try { name = decodeURIComponent(name); } catch { return; }
  const target = name && document.getElementById(name);
  if (!target) return;
  for (let e = target; e; e = e.parentElement) {
    if (e.tagName === "DETAILS") e.open = true;
    if (e.dataset && e.dataset.k !== undefined) e.hidden = false;
  }
  goTo(target);
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
  const table = document.getElementById("findings-table");
  let sorted = "";
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
  // what is chosen lives in the address, behind "#?": a link to it shows the same
  const remember = () => {
    const chosen = new URLSearchParams();
    for (const field of [text, ...selects]) if (field.value) chosen.set(field.name, field.value);
    if (sorted) chosen.set("sort", sorted);
    history.replaceState(null, "", `${location.pathname}${location.search}${chosen.size ? `#?${chosen}` : ""}`);
  };
  const recall = () => {
    if (!location.hash.startsWith("#?")) return;
    const chosen = new URLSearchParams(location.hash.slice(2));
    for (const field of [text, ...selects]) field.value = chosen.get(field.name) || "";
    for (const field of selects) if (field.selectedIndex < 0) field.value = "";
    sorted = chosen.get("sort") || "";
    if (table && sorted) table.dispatchEvent(new CustomEvent("sort-table", { bubbles: true, detail: sorted }));
    apply();
    goTo(document.getElementById("findings"));
  };
  const changed = () => { apply(); remember(); };
  form.hidden = false;
  form.addEventListener("input", changed);
  form.addEventListener("change", changed);
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("reset", () => setTimeout(() => { sorted = ""; changed(); }));
  if (table) table.addEventListener("sorted", (event) => { sorted = event.detail; remember(); });
  addEventListener("hashchange", recall);
  apply();
  recall();
})();

(() => {
  // the printed page is the incident report: a page for each drive with findings, and on it the moments that tell what happened
  const most = 12;
  const fewer = 8;
  let opened = [];
  addEventListener("beforeprint", () => {
    const telling = [...document.querySelectorAll(".drive.telling")];
    const drives = telling.slice(0, telling.length > most ? fewer : most);
    const moments = drives.length > 3 ? 1 : 6;
    document.body.classList.toggle("compact", drives.length > 3);
    const inside = drives.flatMap((d) => [...d.querySelectorAll(".ego.telling, .moment.leading")]);
    inside.push(...document.querySelectorAll(".on-paper"));
    opened = [...drives, ...inside, ...(document.querySelectorAll(".overtake").length > 4 ? [] : document.querySelectorAll(".overtake"))]
      .filter((e) => !e.open && !(Number(e.dataset.rank) >= moments));
    for (const e of opened) e.open = true;
  });
  addEventListener("afterprint", () => {
    for (const e of opened) e.open = false;
  });
})();
