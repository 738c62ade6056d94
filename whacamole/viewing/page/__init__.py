"""``DATASET/index.html``: every sequence of a dataset on one offline page."""

from whacamole.viewing.page.write import page_html, write_page

__all__ = ["page_html", "write_page"]
