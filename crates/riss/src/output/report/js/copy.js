// Tables to the clipboard: `addCopyButton`.

async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // Some browsers keep the clipboard from files that were opened from a disk.
    const area = element("textarea", { class: "skip" });
    area.value = text;
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
}

/** Adds a button to a place of the page that copies a table for spreadsheets. */
function addCopyButton(table, name, place) {
  const button = element("button", { type: "button", "aria-label": `Copy the table of ${name}` }, "Copy");
  button.addEventListener("click", async () => {
    const line = (row) => [...row.cells].map((cell) => cell.dataset.value ?? cell.textContent).join("\t");
    await copyText([...table.rows].map(line).join("\n") + "\n");
    button.textContent = "Copied";
    setTimeout(() => { button.textContent = "Copy"; }, 1500);
  });
  place.append(button);
}
