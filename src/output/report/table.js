const events = $("events-table");
if (events) {
  const body = events.tBodies[0], all = [...body.rows];
  const heads = [...events.tHead.rows[0].cells];
  const label = add(null, "label", { class: "filter" }, "Filter ");
  const filter = add(label, "input", { type: "search", placeholder: "matrix tension" });
  const count = add(label, "span", { role: "status" });
  events.parentElement.before(label);
  filter.addEventListener("input", () => {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const row of all) {
      row.hidden = !words.every((word) => row.textContent.toLowerCase().includes(word));
      shown += !row.hidden;
    }
    count.textContent = words.length ? ` ${shown} of ${all.length}` : "";
  });
  heads.forEach((head, k) => {
    const button = add(null, "button", { type: "button" });
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const up = head.getAttribute("aria-sort") !== "ascending";
      heads.forEach((h) => h.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", up ? "ascending" : "descending");
      const text = (row) => row.cells[k].textContent;
      const order = head.classList.contains("number")
        ? (a, b) => Number(text(a)) - Number(text(b))
        : (a, b) => text(a).localeCompare(text(b), "en", { numeric: true });
      body.append(...[...all].sort((a, b) => up ? order(a, b) : order(b, a)));
    });
  });
}
