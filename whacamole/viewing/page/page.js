"use strict";
// Everything that comes from the dataset reaches the page as text or as an encoded address, never as markup.
(() => {
  const STEP = 60, AHEAD = 800; // cards added at a time, pixels below the window that are filled
  const CELL = 384, GAP = 6, COLUMNS = 5; // of preview.jpg: frames above, the same with labels below
  const byId = (name) => document.getElementById(name);
  const data = JSON.parse(byId("rows").textContent);
  const rows = data.rows.map((row) => Object.fromEntries(data.columns.map((name, i) => [name, row[i]])));
  const form = byId("filters"), cards = byId("cards"), detail = byId("detail");
  const filters = ["shots", "stage", "people", "source", "split"];
  let shown = [], drawn = 0;

  const make = (tag, text, className) => {
    const element = document.createElement(tag);
    if (text !== undefined) element.textContent = text;
    if (className) element.className = className;
    return element;
  };
  const folder = (row) => "sequences/" + encodeURIComponent(row.id) + "/";
  const preview = (row, ending) => "previews/" + encodeURIComponent(row.id) + ending;
  const valuesOf = (row, name) => (Array.isArray(row[name]) ? row[name] : [row[name]]).map(String);
  const plural = (count, word) => count.toLocaleString("en") + " " + word + (count === 1 ? "" : "s");

  function fillFilters() {
    for (const name of filters) {
      const counts = new Map();
      for (const row of rows) for (const value of valuesOf(row, name)) counts.set(value, (counts.get(value) || 0) + 1);
      const numeric = name === "people";
      const names = [...counts.keys()].sort((a, b) => (numeric ? a - b : a.localeCompare(b)));
      form.elements[name].append(new Option("all", ""), ...names.map((value) => new Option(`${value} (${counts.get(value)})`, value)));
    }
  }

  function choose() {
    const words = form.elements.words.value.trim().toLowerCase().split(/\s+/).filter(Boolean);
    shown = rows.filter((row) =>
      filters.every((name) => !form.elements[name].value || valuesOf(row, name).includes(form.elements[name].value)) &&
      words.every((word) => (row.id + " " + row.motion).toLowerCase().includes(word)));
    const order = form.elements.order.value;
    if (order === "frames") shown.sort((a, b) => b.frames - a.frames);
    if (order === "visible") shown.sort((a, b) => a.visible - b.visible);
    if (order === "findings") shown.sort((a, b) => b.findings.length - a.findings.length);
    const frames = shown.reduce((sum, row) => sum + row.frames, 0);
    byId("count").value = `${shown.length.toLocaleString("en")} of ${plural(rows.length, "sequence")}, ${plural(frames, "frame")}`;
    cards.replaceChildren();
    drawn = 0;
    more();
    keep();
  }

  function more() {
    do {
      const next = shown.slice(drawn, drawn + STEP);
      cards.append(...next.map(card));
      drawn += next.length;
    } while (drawn < shown.length && byId("end").getBoundingClientRect().top < innerHeight + AHEAD);
  }

  // One cell of preview.jpg fills the card; the pointer's place chooses which, with the labels drawn.
  function picture(row) {
    const box = make("div", undefined, "picture"), image = new Image();
    const columns = Math.max(1, Math.min(COLUMNS, row.frames)), share = (CELL + GAP) / CELL;
    box.style.aspectRatio = `${row.width} / ${row.height}`;
    image.loading = "lazy";
    image.alt = "";
    image.width = CELL;
    image.style.width = `${(columns * share - GAP / CELL) * 100}%`;
    const look = (column, labelled) => {
      const height = Math.round(CELL * row.height / row.width);
      image.style.left = `${-column * share * 100}%`;
      image.style.top = labelled ? `${-(height + GAP) / height * 100}%` : "0";
    };
    const middle = columns >> 1;
    look(middle, false);
    box.addEventListener("pointermove", (event) => {
      const at = event.offsetX + (event.target === image ? image.offsetLeft : 0);
      look(Math.max(0, Math.min(columns - 1, Math.floor(at / box.clientWidth * columns))), true);
    });
    box.addEventListener("pointerleave", () => look(middle, false));
    image.addEventListener("error", () => { // no preview: the frame in the middle
      image.style.width = "100%";
      look(0, false);
      image.src = folder(row) + "rgb/" + String(row.frames >> 1).padStart(6, "0") + "." + row.image;
    }, { once: true });
    image.src = folder(row) + "preview.jpg";
    box.append(image);
    return box;
  }

  function card(row) {
    const element = make("button", undefined, "card"), words = make("div", undefined, "words");
    element.type = "button";
    element.dataset.id = row.id;
    words.append(make("b", row.id),
      make("span", row.shots.join(", ") || "no shot named"),
      make("span", `${row.stage}, ${row.people === 1 ? "1 person" : row.people + " people"}, ${plural(row.frames, "frame")}, ${row.split}`));
    if (row.findings.length) words.append(make("span", plural(row.findings.length, "finding"), "finding"));
    element.append(picture(row), words);
    element.addEventListener("click", () => open(row));
    return element;
  }

  function link(text, address) {
    const element = make("a", text);
    element.href = address;
    return element;
  }

  function open(row) {
    const bar = make("nav"), close = make("button", "Close"), facts = make("dl"), strip = new Image();
    close.addEventListener("click", () => detail.close());
    bar.append(make("b", row.id));
    if (row.links & 1) bar.append(link("3D scene", preview(row, ".html")));
    if (row.links & 2) bar.append(link("video", preview(row, ".mp4")));
    if (row.links & 4) bar.append(link("sheet", preview(row, ".jpg")));
    bar.append(link("files", folder(row)), link("shot.json", folder(row) + "shot.json"), close);
    strip.src = folder(row) + "preview.jpg";
    strip.alt = "frames above, the labelled bodies over them below";
    const lines = [["motion", row.motion], ["motions from", row.source], ["shots", row.shots.join(", ")], ["stage", row.stage],
      ["people", row.people + (row.together ? ", recorded together" : "")],
      ["frames", `${row.frames} at ${row.fps} a second, ${row.width} x ${row.height}`], ["split", row.split],
      ["mean visible fraction", row.visible < 0 ? "not stated" : row.visible], ["look around", "whacamole view DATASET " + row.id]];
    for (const [name, value] of lines) facts.append(make("dt", name), make("dd", String(value)));
    detail.replaceChildren(bar, strip, facts, ...row.findings.map((text) => make("p", text, "finding")));
    if (row.links & 2) {
      const video = document.createElement("video");
      video.controls = video.loop = true;
      video.preload = "none";
      video.src = preview(row, ".mp4");
      strip.after(video);
    }
    detail.showModal();
  }

  // The filters stand in the address, so that a choice can be bookmarked.
  function keep() {
    const set = new URLSearchParams();
    for (const [name, value] of new FormData(form)) if (value && !(name === "order" && value === "id")) set.set(name, value);
    history.replaceState(null, "", "#" + set);
  }

  function restore() {
    for (const [name, value] of new URLSearchParams(location.hash.slice(1)))
      if (form.elements[name]) form.elements[name].value = value;
  }

  fillFilters();
  restore();
  choose();
  form.addEventListener("input", choose);
  form.addEventListener("reset", () => setTimeout(choose));
  form.addEventListener("submit", (event) => event.preventDefault());
  detail.addEventListener("click", (event) => { if (event.target === detail) detail.close(); });
  new IntersectionObserver((entries) => { if (entries.some((entry) => entry.isIntersecting)) more(); },
    { rootMargin: `${AHEAD}px` }).observe(byId("end"));
})();
